// The end of a first interval as long as the total path.
#include "common_layers.glsl"

uniform sampler2D front;
uniform sampler2D path;

out float path_exit;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec2 sum = texelFetch(path, here, 0).rg;
    // not as many exits as entries: an open surface, or the camera inside
    path_exit = sum.y != 0.0 ? 0.0 : texelFetch(front, here, 0).r + max(sum.x, 0.0);
}
