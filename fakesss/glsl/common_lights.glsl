// The diffuse and specular terms of equation 3.6, summed over the lights that shine.
#include "common_exact.glsl"
#include "common_light.glsl"
#include "common_view.glsl"

#define LIGHTS 1  // how many shine
#define LOCAL_LIGHTS 0  // 1: some of them have a place
#define SPOTS 0  // 1: some of those are spots
#define HIGHLIGHT 0  // 1: there is a highlight
#define HAS_SHADOW_MAPS 0  // 1: some cast shadows

uniform vec4 light_place[LIGHTS];  // homogeneous, eye frame: unit vector towards the light and 0, or its place and 1
uniform vec3 diffuse_colour[LIGHTS];  // wd Kd Id
#if LOCAL_LIGHTS
uniform vec3 light_attenuation[LIGHTS];  // kc, kl, kq
#endif
#if SPOTS
uniform vec3 light_axis[LIGHTS];  // unit, from the sphere's centre to the light
uniform vec3 light_cone[LIGHTS];  // 1 - cos of the half angle, exponent, 1 for a linear fall-off
#endif
#if HIGHLIGHT
uniform vec3 specular_colour[LIGHTS];  // ws ks Is
uniform float shininess;  // n
#endif
#if HAS_SHADOW_MAPS
#include "common_shadow.glsl"
#endif

// The share of light i's intensity that arrives at `point`, and the unit vector to the light.
float arriving(int i, vec3 point, out vec3 to_light) {
#if LOCAL_LIGHTS
    vec3 towards = light_place[i].xyz - light_place[i].w * point;
    float d = max(length(towards), NEAREST);
    to_light = light_place[i].w == 0.0 ? light_place[i].xyz : towards / d;  // to the bit as without local lights
    float share = attenuation(d, light_attenuation[i]);
#if SPOTS
    float v = versine(light_axis[i], to_light);
    vec3 cone = light_cone[i];
    share *= cone.z > 0.0 ? spot_linear(v, cone.x) : spot_exponent(v, cone.x, cone.y);
#endif
    return share;
#else
    to_light = light_place[i].xyz;
    return 1.0;
#endif
}

// What was there `before` and what the lights add to it; `point` counts only where lights have a place or cast shadows.
vec3 lit(vec3 before, vec3 normal, vec3 point, vec2 place) {
    EXACT vec3 colour = before;
    for (int i = 0; i < LIGHTS; ++i) {
        vec3 to_light;
        float share = arriving(i, point, to_light);
        float n_dot_l = dot(normal, to_light);
#if HAS_SHADOW_MAPS
        if (n_dot_l > 0.0 && share > 0.0) share *= unshadowed(i, point, normal, n_dot_l);
#endif
        EXACT vec3 scattered = share * lambert(n_dot_l) * diffuse_colour[i];
        colour += scattered;
#if HIGHLIGHT
        vec3 between = to_light + to_viewer(place);  // the zero vector where the light is straight behind what is seen
        vec3 halfway = between * inversesqrt(max(dot(between, between), 1e-20));
        EXACT vec3 mirrored = share * blinn_phong(n_dot_l, dot(normal, halfway), shininess) * specular_colour[i];
        colour += mirrored;
#endif
    }
    return colour;
}
