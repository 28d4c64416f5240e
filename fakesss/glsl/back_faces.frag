// The nearest of the faces that are drawn: with front faces culled, where light leaves a solid first.
#include "common_layers.glsl"

in float layer;
out float nearest_back;

void main() {
    nearest_back = in_sphere(layer);
}
