// Thickness to the softened second layer, which is softened here or was, at fewer samples, before.
#include "common_layers.glsl"

#define SPARSE 0  // 1: the softened layer has every n-th sample across and down

uniform float open_thickness;
#if SPARSE
#include "common_upsample.glsl"
uniform sampler2D softened;
#else
#include "common_blur.glsl"
#endif

// `z1` is the front layer at `place`, shares of the picture's width and height.
float blurred_thickness_behind(sampler2D front, float z1, vec2 place) {
#if SPARSE
    return relative_thickness(z1, upsampled(softened, front, z1, place), open_thickness);
#else
    float z2 = layer_at(place);
    float soft = relative_thickness(z1, blurred(compared(z2), place), open_thickness);
#if AS_PUBLISHED
    return soft;
#else
    return is_empty(z2) ? open_thickness : soft;
#endif
#endif
}
