#include "common_upsample.glsl"

uniform sampler2D front;
uniform sampler2D sparse_back;

out float upsampled_back;

void main() {
    vec2 place = gl_FragCoord.xy / vec2(textureSize(front, 0));
    upsampled_back = upsampled(sparse_back, front, texture(front, place).r, place);
}
