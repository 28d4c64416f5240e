// Stretches of matter added up, each weighted down by the gaps before it: see passes/bridge.py.
#include "common_layers.glsl"

uniform sampler2D front;
uniform sampler2D layer_2;
uniform sampler2D layer_3;
uniform sampler2D layer_4;
uniform sampler2D layer_5;
uniform sampler2D layer_6;
uniform float gap;  // width after which matter counts 1/e, sphere radii

out float bridged_exit;

struct Way {
    float depth;  // of the surface met last
    int entered;  // front faces met, less back faces
    float gaps;   // width of those passed
    float path;
};

// Goes on to the next layer, negative where it is of a front face; stays where there is none.
Way onwards(Way way, float layer) {
    if (is_empty(layer)) return way;
    float stretch = max(abs(layer) - way.depth, 0.0);
    bool inside = way.entered > 0;
    way.path += inside ? exp(-way.gaps / gap) * stretch : 0.0;
    way.gaps += inside ? 0.0 : stretch;
    way.entered += layer < 0.0 ? 1 : -1;
    way.depth = abs(layer);
    return way;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    float z1 = texelFetch(front, here, 0).r;
    float z2 = texelFetch(layer_2, here, 0).r;
    Way way = onwards(Way(z1, 1, 0.0, 0.0), z2);
    way = onwards(way, texelFetch(layer_3, here, 0).r);
    way = onwards(way, texelFetch(layer_4, here, 0).r);
    way = onwards(way, texelFetch(layer_5, here, 0).r);
    way = onwards(way, texelFetch(layer_6, here, 0).r);
    bridged_exit = is_empty(z2) ? 0.0 : z1 + way.path;
}
