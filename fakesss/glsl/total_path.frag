// Signed sum over all faces: what is left is the length of the ray inside, along the view axis.
#include "common_layers.glsl"

in float layer;
out vec2 path;

void main() {
    float sign = gl_FrontFacing ? -1.0 : 1.0;
    path = vec2(sign * (in_sphere(layer) - ORIGIN), sign);  // from the sphere's centre: small terms, small rounding
}
