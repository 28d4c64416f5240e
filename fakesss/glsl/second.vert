#include "common_projection.glsl"

in vec3 in_eye;

invariant gl_Position;  // as in front.vert
out float depth;

void main() {
    gl_Position = project(in_eye);
    depth = in_eye.z;
}
