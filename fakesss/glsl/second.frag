// One step of depth peeling (Everitt, Interactive order-independent transparency, 2001): the nearest surface behind
// the front layer.
#include "common_depth.glsl"
#include "common_layers.glsl"

#define AS_PUBLISHED 0  // 1: compares non-linear depths, as the program of 2011 did
#define PEEL_EPSILON 1e-5  // sphere diameters: above float32 rounding at any distance below 100 radii
#define PUBLISHED_EPSILON 1e-6  // thesis appendix B, in non-linear depth

uniform sampler2D front;
#if AS_PUBLISHED
uniform vec2 clip;
#endif

in float depth;
out float second;

void main() {
    float nearest = texelFetch(front, ivec2(gl_FragCoord.xy), 0).r;
#if AS_PUBLISHED
    bool behind = nonlinear_depth(depth, clip) > nonlinear_depth(nearest, clip) + PUBLISHED_EPSILON;
#else
    bool behind = depth > nearest + PEEL_EPSILON * DIAMETER;
#endif
    if (!behind) discard;
    second = depth;
}
