#include "common_thickness.glsl"

uniform sampler2D front;

out float thickness;

void main() {
    vec2 place = gl_FragCoord.xy / vec2(textureSize(front, 0));
    thickness = thickness_behind(texture(front, place).r, place);
}
