// t = (z2 - z1) / d, thesis section 3.1, held to 0..1.
#include "common_layers.glsl"

uniform sampler2D front;
uniform sampler2D second;
uniform float open_thickness;  // where nothing lies behind the front layer

out float thickness;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    float z1 = texelFetch(front, here, 0).r;
    if (is_empty(z1)) discard;
    thickness = relative_thickness(z1, texelFetch(second, here, 0).r, open_thickness);
}
