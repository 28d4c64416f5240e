// Lighting equation 3.6: Gascons, Fast simulation of translucent objects, 2011.
#include "common_exact.glsl"
#include "common_brdf.glsl"
#include "common_layers.glsl"
#include "common_normal_range.glsl"

#define LIGHTS 1  // how many shine
#define CONSTANT_BACKLIGHT 0  // 1: the backlight is the same at any thickness
#define NEEDS_POSITION 0  // 1: some of them have a place or cast shadows
#define HAS_SCREEN_OCCLUSION 0  // 1: ambient occlusion comes from the front layer, and that of `surface` is 1
#define HAS_THICKNESS 0  // 1: the backlight reads the exact second layer; 2: computed here
#define HAS_BLURRED_THICKNESS 0  // 1: the backlight reads the softened second layer; 2: computed here

uniform sampler2D surface;
uniform vec3 ambient_colour;  // ka Kd Ia
uniform float exposure;
#if HAS_SCREEN_OCCLUSION
uniform sampler2D screen_occlusion;
#endif
#if LIGHTS
#include "common_lights.glsl"
#endif

#if NEEDS_POSITION
uniform float camera_distance;  // from the sphere's centre, sphere radii
#endif
#if NEEDS_POSITION || HAS_BLURRED_THICKNESS == 2 || HAS_THICKNESS == 2
uniform sampler2D front;
#endif
#if HAS_BLURRED_THICKNESS == 2
#include "common_blurred_thickness.glsl"
#elif HAS_BLURRED_THICKNESS == 1
uniform sampler2D blurred_thickness;
#elif HAS_THICKNESS == 2
#include "common_thickness.glsl"
#elif HAS_THICKNESS == 1
uniform sampler2D thickness;
#endif
#if HAS_THICKNESS || HAS_BLURRED_THICKNESS || CONSTANT_BACKLIGHT
uniform vec3 backlight_colour;     // wb (Kd + Kb)
#endif
#if HAS_THICKNESS || HAS_BLURRED_THICKNESS
uniform float thickness_exponent;  // r

// texture() is faster than texelFetch() on a software rasteriser; at a sample's centre both read that sample.
float thickness_here(vec2 place) {
#if HAS_BLURRED_THICKNESS == 2
    return blurred_thickness_behind(front, texture(front, place).r, place);
#elif HAS_BLURRED_THICKNESS == 1
    return texture(blurred_thickness, place).r;
#elif HAS_THICKNESS == 2
    return thickness_behind(texture(front, place).r, place);
#else
    return texture(thickness, place).r;
#endif
}
#endif

out vec4 shaded;

void main() {
    vec2 place = gl_FragCoord.xy / vec2(textureSize(surface, 0));
    vec4 normal_occlusion = texture(surface, place);
    vec3 normal = normal_occlusion.xyz;
    EXACT vec3 colour = normal_occlusion.w * ambient_colour;
#if HAS_SCREEN_OCCLUSION
    colour *= texture(screen_occlusion, place).r;
#endif
#if LIGHTS
#if NEEDS_POSITION
    vec3 point = position(texture(front, place).r, place, camera_distance);
#else
    vec3 point = vec3(0.0);
#endif
    colour = lit(colour, normal, point, place);
#endif
#if HAS_THICKNESS || HAS_BLURRED_THICKNESS
    EXACT vec3 through = backlight(thickness_here(place), thickness_exponent) * backlight_colour;
    colour += through;
#elif CONSTANT_BACKLIGHT
    colour += backlight_colour;
#endif
    // not -0 where the backlight is negative
    shaded = vec4(exposure > 0.0 ? in_normal_range(exposure * colour) : vec3(0.0), 1.0);
}
