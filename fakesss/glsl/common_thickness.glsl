// t = (z2 - z1) / d, thesis section 3.1, held to 0..1.
#include "common_layers.glsl"

uniform sampler2D second;
uniform float open_thickness;  // where nothing lies behind the front layer

float thickness_behind(float z1, vec2 place) {
    return relative_thickness(z1, texture(second, place).r, open_thickness);
}
