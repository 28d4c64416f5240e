// Intervals of matter added up, each weighted down by the gaps before it: see passes/bridge.py.
#include "common_layers.glsl"

uniform sampler2D front;
uniform sampler2D first_exit;
uniform sampler2D layer_3;
uniform sampler2D layer_4;
uniform sampler2D layer_5;
uniform sampler2D layer_6;
uniform float gap;  // width after which matter counts 1/e, sphere radii

out float bridged_exit;

// What a further interval adds, `gaps` behind the first one: nothing if it is not there or never ends.
float further(float entry, float leave, float gaps) {
    return is_empty(entry) || is_empty(leave) ? 0.0 : exp(-max(gaps, 0.0) / gap) * (leave - entry);
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    float z1 = texelFetch(front, here, 0).r, z2 = texelFetch(first_exit, here, 0).r;
    float z3 = texelFetch(layer_3, here, 0).r, z4 = texelFetch(layer_4, here, 0).r;
    float z5 = texelFetch(layer_5, here, 0).r, z6 = texelFetch(layer_6, here, 0).r;
    float path = z2 - z1 + further(z3, z4, z3 - z2) + further(z5, z6, z3 - z2 + z5 - z4);
    bridged_exit = is_empty(z2) ? 0.0 : z1 + path;
}
