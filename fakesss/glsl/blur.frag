#include "common_blur.glsl"

uniform sampler2D front;

out float blurred_thickness;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec2 place = gl_FragCoord.xy / vec2(textureSize(front, 0));
    blurred_thickness = blurred_thickness_behind(texelFetch(front, here, 0).r, here, place);
}
