// One step of depth peeling (Everitt, Interactive order-independent transparency, 2001): the nearest surface behind
// the front layer.
#include "common_depth.glsl"
#include "common_layers.glsl"

#define AS_PUBLISHED 0  // 1: compares non-linear depths, as the program of 2011 did
#define PEEL_EPSILON 1e-5  // sphere diameters: well above float32 rounding of a layer
#define PUBLISHED_EPSILON 1e-6  // thesis appendix B, in non-linear depth

uniform sampler2D front;
#if AS_PUBLISHED
uniform vec2 clip;
uniform float distance;
#endif

in float layer;
out float second;

#if AS_PUBLISHED
float window(float layer) { return nonlinear_depth(layer - ORIGIN + distance, clip); }
#endif

void main() {
    float nearest = texelFetch(front, ivec2(gl_FragCoord.xy), 0).r;
#if AS_PUBLISHED
    bool behind = window(layer) > window(nearest) + PUBLISHED_EPSILON;
#else
    bool behind = layer > nearest + PEEL_EPSILON * DIAMETER;
#endif
    if (!behind) discard;
    second = layer;
}
