// A layer softened for whoever reads it next, rather than in place.
#include "common_blur.glsl"

uniform vec2 size;  // of the target, samples

out float softened;

void main() {
    vec2 place = gl_FragCoord.xy / size;
    float centre = layer_at(place);
    softened = is_empty(centre) ? 0.0 : blurred(centre, place);
}
