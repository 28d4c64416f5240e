// The nearest surface: what the picture shows, before any light.
#include "common_layers.glsl"

in float layer;
in vec3 normal;
in float occlusion;

layout(location = 0) out float front;
layout(location = 1) out vec4 surface;  // unit normal in the eye frame, share of the hemisphere that is open

void main() {
    // An open sheet seen from behind shows its back with the normal turned to the viewer.
    vec3 facing = gl_FrontFacing ? normal : -normal;
    float squared = dot(facing, facing);
    front = in_sphere(layer);
    surface = vec4(squared > 0.0 ? facing * inversesqrt(squared) : vec3(0.0), clamp(occlusion, 0.0, 1.0));
}
