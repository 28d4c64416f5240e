// Twin of screen_occlusion.sampled. Ambient occlusion from the front layer: Mittring, Finding next gen: CryEngine 2,
// 2007, over the normal's hemisphere: Filion and McNaughton, StarCraft II: effects and techniques, 2008. Points stand
// four to a direction, as if along a ray that is blocked if one of them is hidden, so that the share of open directions
// is what the bake counts with rays.
#include "common_tile.glsl"
#include "common_view.glsl"

#define DIRECTIONS 16  // of the points around each sample of the picture
#define UNIFORM_OVER_HEMISPHERE 0  // 1: directions spread evenly; 0: by their cosine to the normal, as irradiance weighs

uniform sampler2D front;
uniform sampler2D surface;
uniform float camera_distance;  // of the sphere's centre
uniform float radius;  // of the hemisphere, sphere radii
uniform float bias;    // sphere radii

const int POINTS = 4;  // of each direction
const float PLASTIC = 0.75487766625;  // 1 / 1.32472: steps of this share spread evenly, and not in step with the angles

// Two unit vectors that make a frame with unit `n`: Duff and others, Building an orthonormal basis, revisited, 2017.
void frame_around(vec3 n, out vec3 s, out vec3 t) {
    float sign = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (sign + n.z);
    float b = n.x * n.y * a;
    s = vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    t = vec3(b, sign + n.y * n.y * a, -n.y);
}

// 1 if the front layer hides `point` in the hemisphere around `middle`, 0 if not; between where what hides it is far
// in front of the surface, and so may be another part with light between.
float hidden(vec3 point, vec3 middle, vec3 normal) {
    float depth = camera_distance - point.z;
    vec2 place = 0.5 + 0.5 * point.xy / (tangent * depth);
    if (depth <= 0.0 || place != clamp(place, 0.0, 1.0)) return 0.0;
    vec2 size = vec2(textureSize(front, 0));
    vec2 centre = (min(floor(place * size), size - 1.0) + 0.5) / size;  // of the texel
    float layer = texture(front, centre).r;  // cheaper than texelFetch on a software rasteriser
    if (is_empty(layer) || ORIGIN - point.z <= layer + bias) return 0.0;
    // What lies under the surface's own plane is no part of the hemisphere: flat and convex surfaces stay open however
    // coarse the texels are.
    float height = dot(position(layer, centre, camera_distance) - middle, normal);
    return height > bias ? clamp(2.0 - (ORIGIN - middle.z - layer) / radius, 0.0, 1.0) : 0.0;
}

out float sampled_occlusion;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec2 place = gl_FragCoord.xy / vec2(textureSize(front, 0));
    vec3 middle = position(texelFetch(front, here, 0).r, place, camera_distance);
    vec3 normal = texelFetch(surface, here, 0).xyz;
    vec3 s, t;
    frame_around(normal, s, t);
    vec2 turned = tile_rotation(here);
    float first = tile_share(here);  // of a direction's points, as a share of the distance between them
    float blocked = 0.0;
    for (int i = 0; i < DIRECTIONS; ++i) {
        float share = (float(i) + 0.5) / float(DIRECTIONS);
#if UNIFORM_OVER_HEMISPHERE
        float up = 1.0 - share;
#else
        float up = sqrt(1.0 - share);
#endif
        vec3 direction = (turned.x * s + turned.y * t) * sqrt(1.0 - up * up) + up * normal;
        float most = 0.0;
        for (int k = 0; k < POINTS; ++k) {
            float reach = radius * (float(k) + first) / float(POINTS);
            most = max(most, hidden(middle + reach * direction, middle, normal));
        }
        blocked += most;
        turned = by_golden_angle(turned);
        first = fract(first + PLASTIC);
    }
    sampled_occlusion = 1.0 - blocked / float(DIRECTIONS);
}
