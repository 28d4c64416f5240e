#include "common_thickness.glsl"

uniform sampler2D front;

out float thickness;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    thickness = thickness_behind(texelFetch(front, here, 0).r, here);
}
