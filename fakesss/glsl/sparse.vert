// As layer.vert, at every n-th sample: the target's sample i stands where sample n i of the picture does.
#include "common_layers.glsl"
#include "common_projection.glsl"

in vec3 in_eye;

uniform vec2 scale;  // of the picture in the target, both from -1 to 1
uniform vec2 shift;

out float layer;

void main() {
    gl_Position = project(in_eye);
    gl_Position.xy = scale * gl_Position.xy + shift * gl_Position.w;
    layer = ORIGIN + in_eye.z;
}
