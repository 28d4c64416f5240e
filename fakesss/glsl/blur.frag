#include "common_blurred_thickness.glsl"

uniform sampler2D front;

out float blurred_thickness;

void main() {
    vec2 place = gl_FragCoord.xy / vec2(textureSize(front, 0));
    blurred_thickness = blurred_thickness_behind(front, texture(front, place).r, place);
}
