// Direct light in one forward pass: what the technique is measured against. Blinn-Phong and baked occlusion, one light.
#include "common_brdf.glsl"

uniform vec2 tangent;          // of the half angles of the picture's width and height
uniform vec2 size;             // of the picture, pixels
uniform vec3 to_light;         // unit, eye frame
uniform vec3 ambient_colour;   // ka Kd Ia
uniform vec3 diffuse_colour;   // wd Kd Id
uniform vec3 specular_colour;  // ws ks Is
uniform float shininess;       // n
uniform float exposure;

in vec3 normal;
in float occlusion;
out vec4 shaded;

void main() {
    vec3 n = normalize(normal);
    vec3 to_viewer = normalize(vec3((1.0 - 2.0 * gl_FragCoord.xy / size) * tangent, 1.0));
    vec3 halfway = normalize(to_light + to_viewer);
    float n_dot_l = dot(n, to_light);
    vec3 colour = occlusion * ambient_colour + lambert(n_dot_l) * diffuse_colour;
    colour += blinn_phong(n_dot_l, dot(n, halfway), shininess) * specular_colour;
    shaded = vec4(exposure * colour, 1.0);
}
