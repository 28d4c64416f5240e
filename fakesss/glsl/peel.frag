// One step of depth peeling (Everitt, Interactive order-independent transparency, 2001): the nearest surface behind
// an earlier layer.
#include "common_depth.glsl"
#include "common_layers.glsl"

#define AS_PUBLISHED 0  // 1: compares non-linear depths, as the program of 2011 did
#define BEFORE_FACES 0  // 1: the layer before is of front faces, -1: of back faces, 0: of either, 2: its sign says which
#define SIGNED 0  // 1: the layer is negative where it is of a front face
#define NEAREST 0  // 1: nothing lies before the layer before
#define HALF 0  // 1: layers are float16, whose rounding is larger
#define PUBLISHED_EPSILON 1e-6  // thesis appendix B, in non-linear depth

// Sphere diameters: well above float32 rounding of a layer, just above float16's of 2^-9 radii.
const float PEEL_EPSILON = HALF == 1 ? 1e-3 : 1e-5;

uniform sampler2D before;
#if AS_PUBLISHED
uniform vec2 clip;
uniform float distance;
#endif

in float layer;
out float behind;

#if AS_PUBLISHED
float window(float layer) { return nonlinear_depth(layer - ORIGIN + distance, clip); }
#endif

void main() {
    float here = in_sphere(layer);
    float earlier = texelFetch(before, ivec2(gl_FragCoord.xy), 0).r;
    float nearest = abs(earlier);
#if AS_PUBLISHED
    bool further = window(here) > window(nearest) + PUBLISHED_EPSILON;
#else
    // What looks the other way is not the layer before itself, however near it is. By rounding it may come to lie
    // before it: a triangle seen edge-on is many depths in one sample.
    bool before_front = BEFORE_FACES == 2 ? earlier < 0.0 : BEFORE_FACES > 0;
    bool other = BEFORE_FACES != 0 && gl_FrontFacing != before_front;
    bool further = here > nearest + (other ? -PEEL_EPSILON : PEEL_EPSILON) * DIAMETER || (other && NEAREST == 1);
#endif
    if (is_empty(nearest) || !further) discard;
    behind = SIGNED == 1 && gl_FrontFacing ? -here : here;
}
