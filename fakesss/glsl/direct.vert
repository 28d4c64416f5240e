#include "common_projection.glsl"

in vec3 in_eye;
in vec3 in_normal;
in float in_occlusion;

out vec3 normal;
out float occlusion;

void main() {
    gl_Position = project(in_eye);
    normal = in_normal;
    occlusion = in_occlusion;
}
