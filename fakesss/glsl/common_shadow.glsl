// Twin of shadow_maps.py: Williams, Casting curved shadows on curved surfaces, 1978; percentage-closer filtering:
// Reeves, Salesin and Cook, Rendering antialiased shadows with depth maps, 1987. All maps stand in one texture.
#include "common_light.glsl"
#include "common_tile.glsl"

#define SHADOW_LIGHTS 1  // length of the arrays
#define SHADOW_FILTER 1  // 0: one comparison; 1: 4 x 4 of them; 2: samples in a disc
#define SHADOW_SAMPLES 8  // of the disc

const float STEEPEST = 30.0;  // slope, depth per length across, from which on a surface counts as no steeper
const float REACH = 0.2;  // sphere radii: a wide disc on a steep plane would else reach past what casts the shadow

uniform sampler2D shadow_maps;  // linear depth as the light sees it, sphere radii
uniform mat3 shadow_turn[SHADOW_LIGHTS];  // from the camera's to the light's (right, up, away)
uniform vec4 shadow_map[SHADOW_LIGHTS];  // number of its first map or -1, width w = y + z depth, half width of map / w
uniform float shadow_cube[SHADOW_LIGHTS];  // depth of the sphere's centre from a light with six maps, else -1
uniform int map_side;  // texels
uniform float shadow_bias;  // sphere radii
#if SHADOW_FILTER == 2
uniform float shadow_radius;  // of the disc, sphere radii
#endif

// clamp(b tan(acos N.L), b, 2 b), finite also at 90 degrees: from N.L = 1/4 down the tangent is above 2 anyway.
float slope_bias(float bias, float n_dot_l) {
    return bias * clamp(sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0)) / max(n_dot_l, 0.25), 1.0, 2.0);
}

// The side of a cube that `p` points to: ahead, back, right, left, up, down.
int cube_side(vec3 p) {
    vec3 a = abs(p);
    if (a.z >= max(a.x, a.y)) return p.z > 0.0 ? 0 : 1;
    if (a.x >= a.y) return p.x > 0.0 ? 2 : 3;
    return p.y > 0.0 ? 4 : 5;
}

// `p` as seen with that side ahead.
vec3 ahead(vec3 p, int side) {
    if (side == 0) return p;
    if (side == 1) return vec3(-p.x, p.y, -p.z);
    if (side == 2) return vec3(-p.z, p.y, p.x);
    if (side == 3) return vec3(p.z, p.y, -p.x);
    return side == 4 ? vec3(p.x, -p.z, p.y) : vec3(p.x, p.z, -p.y);
}

// How the depth of a surface changes across the light's view, per length at its own depth (Isidoro, Shadow mapping:
// GPU-based tips and techniques, 2006): `along` is the ray from the light, of length 1 along the map's axis.
vec2 depth_slope(vec3 normal, vec3 along) {
    vec2 slope = -normal.xy / min(dot(normal, along), -1e-6);
    return slope * min(1.0, STEEPEST / max(length(slope), 1e-6));
}

// 1 where the surface at `depth` is lit, seen through the texel of `tap`. What hides it there must be nearer to the light
// than the point itself and than the surface's plane at the texel, or the surface would hide itself.
float passes(vec2 tap, vec2 texel, ivec2 corner, float depth, vec2 slope) {
    vec2 centre = floor(clamp(tap, vec2(0.0), vec2(map_side - 1))) + 0.5;
    vec2 place = (vec2(corner) + centre) / vec2(textureSize(shadow_maps, 0));
    float plane = clamp(dot(slope, centre - texel), -REACH, 0.0);
    return depth + plane > textureLod(shadow_maps, place, 0.0).r ? 0.0 : 1.0;
}

// `texel` is the place in the map whose first texel is `corner`, `slope` that of the surface per texel.
float filtered(vec2 texel, ivec2 corner, float depth, vec2 slope, float texels_per_radius) {
#if SHADOW_FILTER == 0
    return passes(texel, texel, corner, depth, slope);
#elif SHADOW_FILTER == 1
    // The outer rows and columns count by how far they reach into a square of 3 x 3 texels around the place: the share
    // changes without jumps as the place moves.
    vec2 first = floor(texel - 0.5), f = texel - 0.5 - first;
    float sum = 0.0;
    for (int y = -1; y <= 2; ++y)
        for (int x = -1; x <= 2; ++x) {
            float weight = (x < 0 ? 1.0 - f.x : x > 1 ? f.x : 1.0) * (y < 0 ? 1.0 - f.y : y > 1 ? f.y : 1.0);
            sum += weight * passes(first + vec2(x, y), texel, corner, depth, slope);
        }
    return sum / 9.0;
#else
    vec2 turned = tile_rotation(ivec2(gl_FragCoord.xy));
    float sum = 0.0;
    for (int k = 0; k < SHADOW_SAMPLES; ++k) {  // Vogel, A better way to construct the sunflower head, 1979
        float radius = sqrt((float(k) + 0.5) / float(SHADOW_SAMPLES)) * texels_per_radius;
        sum += passes(texel + radius * turned, texel, corner, depth, slope);
        turned = by_golden_angle(turned);
    }
    return sum / float(SHADOW_SAMPLES);
#endif
}

// The share of light i that no part of the object keeps from `point`.
float unshadowed(int i, vec3 point, vec3 normal, float n_dot_l) {
    vec4 map = shadow_map[i];
    if (map.x < 0.0) return 1.0;
    vec3 p = shadow_turn[i] * vec3(point.xy, -point.z), n = shadow_turn[i] * vec3(normal.xy, -normal.z);
    int number = int(map.x);
    if (shadow_cube[i] >= 0.0) {
        p.z += shadow_cube[i];
        int side = cube_side(p);
        p = ahead(p, side);
        n = ahead(n, side);
        number += side;
    }
    float width = map.y + map.z * p.z;
    if (width < NEAREST) return 1.0;  // nearer than any map begins, or behind a spot, where none of its light arrives
    vec2 texel = (p.xy / (width * map.w) * 0.5 + 0.5) * float(map_side);
    float texel_width = 2.0 * width * map.w / float(map_side);
    vec2 slope = depth_slope(n, vec3(map.z * p.xy / width, 1.0)) * texel_width;
    int columns = textureSize(shadow_maps, 0).x / map_side;
    ivec2 corner = ivec2(number % columns, number / columns) * map_side;
#if SHADOW_FILTER == 2
    float texels_per_radius = shadow_radius / texel_width;
#else
    float texels_per_radius = 0.0;
#endif
    return filtered(texel, corner, p.z - slope_bias(shadow_bias, n_dot_l), slope, texels_per_radius);
}
