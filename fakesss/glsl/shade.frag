// Lighting equation 3.6: Gascons, Fast simulation of translucent objects, 2011.
#include "common_brdf.glsl"
#include "common_layers.glsl"

#define HAS_THICKNESS 0  // 1: the backlight reads the exact second layer
#define HAS_BLURRED_THICKNESS 0  // 1: the backlight reads the softened second layer

uniform sampler2D front;
uniform sampler2D surface;
uniform vec2 tangent;         // of the half angles of the picture's width and height
uniform vec3 to_light;        // unit, eye frame
uniform vec3 ambient_colour;  // ka Kd Ia
uniform vec3 diffuse_colour;  // wd Kd Id
uniform vec3 specular_colour; // ws ks Is
uniform float shininess;      // n
uniform float exposure;
#if HAS_THICKNESS
uniform sampler2D thickness;
#define LAYER thickness
#elif HAS_BLURRED_THICKNESS
uniform sampler2D blurred_thickness;
#define LAYER blurred_thickness
#endif
#ifdef LAYER
uniform vec3 backlight_colour;     // wb (Kd + Kb)
uniform float thickness_exponent;  // r
#endif

out vec4 shaded;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    if (is_empty(texelFetch(front, here, 0).r)) discard;
    vec4 normal_occlusion = texelFetch(surface, here, 0);
    vec3 normal = normal_occlusion.xyz;
    vec2 centred = gl_FragCoord.xy / vec2(textureSize(front, 0)) * 2.0 - 1.0;
    vec3 to_viewer = normalize(vec3(-centred * tangent, 1.0));
    vec3 between = to_light + to_viewer;  // the zero vector where the light is straight behind what is seen
    vec3 halfway = between * inversesqrt(max(dot(between, between), 1e-20));
    float n_dot_l = dot(normal, to_light);
    vec3 colour = normal_occlusion.w * ambient_colour;
    colour += lambert(n_dot_l) * diffuse_colour;
    colour += blinn_phong(n_dot_l, dot(normal, halfway), shininess) * specular_colour;
#ifdef LAYER
    colour += backlight(texelFetch(LAYER, here, 0).r, thickness_exponent) * backlight_colour;
#endif
    shaded = vec4(exposure * colour, 1.0);
}
