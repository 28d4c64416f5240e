// Lighting equation 3.6: Gascons, Fast simulation of translucent objects, 2011.
#include "common_brdf.glsl"
#include "common_layers.glsl"

#define HIGHLIGHT 0  // 1: there is a highlight
#define HAS_SCREEN_OCCLUSION 0  // 1: ambient occlusion comes from the front layer, and that of `surface` is 1
#define HAS_THICKNESS 0  // 1: the backlight reads the exact second layer; 2: computed here
#define HAS_BLURRED_THICKNESS 0  // 1: the backlight reads the softened second layer; 2: computed here

uniform sampler2D surface;
uniform vec3 to_light;        // unit, eye frame
uniform vec3 ambient_colour;  // ka Kd Ia
uniform vec3 diffuse_colour;  // wd Kd Id
uniform float exposure;
#if HAS_SCREEN_OCCLUSION
uniform sampler2D screen_occlusion;
#endif
#if HIGHLIGHT
uniform vec2 tangent;         // of the half angles of the picture's width and height
uniform vec3 specular_colour; // ws ks Is
uniform float shininess;      // n
#endif

#if HAS_BLURRED_THICKNESS == 2 || HAS_THICKNESS == 2
uniform sampler2D front;
#endif
#if HAS_BLURRED_THICKNESS == 2
#include "common_blur.glsl"
#elif HAS_BLURRED_THICKNESS == 1
uniform sampler2D blurred_thickness;
#elif HAS_THICKNESS == 2
#include "common_thickness.glsl"
#elif HAS_THICKNESS == 1
uniform sampler2D thickness;
#endif
#if HAS_THICKNESS || HAS_BLURRED_THICKNESS
uniform vec3 backlight_colour;     // wb (Kd + Kb)
uniform float thickness_exponent;  // r

float thickness_here(ivec2 here, vec2 place) {
#if HAS_BLURRED_THICKNESS == 2
    return blurred_thickness_behind(texelFetch(front, here, 0).r, here, place);
#elif HAS_BLURRED_THICKNESS == 1
    return texelFetch(blurred_thickness, here, 0).r;
#elif HAS_THICKNESS == 2
    return thickness_behind(texelFetch(front, here, 0).r, here);
#else
    return texelFetch(thickness, here, 0).r;
#endif
}
#endif

#if HIGHLIGHT
vec3 highlight(vec3 normal, vec2 place) {
    vec3 to_viewer = normalize(vec3((1.0 - 2.0 * place) * tangent, 1.0));
    vec3 between = to_light + to_viewer;  // the zero vector where the light is straight behind what is seen
    vec3 halfway = between * inversesqrt(max(dot(between, between), 1e-20));
    return blinn_phong(dot(normal, to_light), dot(normal, halfway), shininess) * specular_colour;
}
#endif

out vec4 shaded;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec2 place = gl_FragCoord.xy / vec2(textureSize(surface, 0));
    vec4 normal_occlusion = texelFetch(surface, here, 0);
    vec3 normal = normal_occlusion.xyz;
    vec3 colour = normal_occlusion.w * ambient_colour;
#if HAS_SCREEN_OCCLUSION
    colour *= texelFetch(screen_occlusion, here, 0).r;
#endif
    colour += lambert(dot(normal, to_light)) * diffuse_colour;
#if HIGHLIGHT
    colour += highlight(normal, place);
#endif
#if HAS_THICKNESS || HAS_BLURRED_THICKNESS
    colour += backlight(thickness_here(here, place), thickness_exponent) * backlight_colour;
#endif
    shaded = vec4(exposure * colour, 1.0);
}
