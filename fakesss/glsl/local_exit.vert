#include "common_layers.glsl"
#include "common_projection.glsl"

in vec3 in_eye;
in float in_thickness;  // sphere diameters

invariant gl_Position;  // as in front.vert
out float leave;

void main() {
    gl_Position = project(in_eye);
    leave = ORIGIN + in_eye.z + DIAMETER * in_thickness;
}
