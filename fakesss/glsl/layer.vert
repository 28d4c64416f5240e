#include "common_layers.glsl"
#include "common_projection.glsl"

in vec3 in_eye;

invariant gl_Position;  // as in front.vert
out float layer;

void main() {
    gl_Position = project(in_eye);
    layer = ORIGIN + in_eye.z;
}
