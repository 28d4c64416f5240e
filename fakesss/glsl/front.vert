#include "common_layers.glsl"
#include "common_projection.glsl"

in vec3 in_eye;
in vec3 in_normal;
in float in_occlusion;

invariant gl_Position;  // the peel compares depths of the same triangle between two passes
out float layer;
out vec3 normal;
out float occlusion;

void main() {
    gl_Position = project(in_eye);
    layer = ORIGIN + in_eye.z;
    normal = in_normal;
    occlusion = in_occlusion;
}
