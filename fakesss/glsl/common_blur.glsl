// Thickness to a second layer that a depth-aware 5x5 Gaussian has softened: thesis section 3.1 and appendix C.2.2.
#include "common_depth.glsl"
#include "common_layers.glsl"

#define AS_PUBLISHED 0  // 1: weights from non-linear depths, background recognised by them
#define PUBLISHED_BACKGROUND 0.99  // thesis appendix C.2.2, in non-linear depth

uniform sampler2D second;
uniform vec2 tap;           // distance between taps, shares of the picture's width and height
uniform float depth_range;  // difference at which a tap's weight reaches 0; sphere radii, or non-linear as published
uniform float open_thickness;
#if AS_PUBLISHED
uniform vec2 clip;
uniform float distance;
#endif

// The usual integer table of a Gaussian with standard deviation 1, by distance from the centre; its sum cancels.
const float KERNEL[9] = float[](41.0, 26.0, 7.0,
                                26.0, 16.0, 4.0,
                                 7.0,  4.0, 1.0);

#if AS_PUBLISHED
float compared(float layer) { return is_empty(layer) ? 1.0 : nonlinear_depth(layer - ORIGIN + distance, clip); }
bool is_background(float window) { return window > PUBLISHED_BACKGROUND; }
float to_layer(float window) { return linear_depth(window, clip) - distance + ORIGIN; }
#else
float compared(float layer) { return layer; }
bool is_background(float layer) { return is_empty(layer); }
float to_layer(float layer) { return layer; }
#endif

float blurred(float centre, vec2 here) {
    float sum = 0.0, weights = 0.0, steepness = 1.0 / depth_range;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            float depth = compared(texture(second, here + tap * vec2(x, y)).r);
            float kernel = KERNEL[3 * abs(y) + abs(x)];
            float off = depth - centre;
            // eq. C.1, g (1 - clamp(|dz| / range, 0, 1)), in one multiplication and addition
            float weight = is_background(depth) ? 0.0 : max(kernel - abs(off) * (kernel * steepness), 0.0);
            sum += weight * off;  // of differences: their rounding is far below that of depths
            weights += weight;
        }
    return to_layer(weights > 0.0 ? centre + sum / weights : centre);
}

// `z1` is the front layer at `place`, shares of the picture's width and height.
float blurred_thickness_behind(float z1, vec2 place) {
    float z2 = texture(second, place).r;
    float soft = relative_thickness(z1, blurred(compared(z2), place), open_thickness);
#if AS_PUBLISHED
    return soft;
#else
    return is_empty(z2) ? open_thickness : soft;
#endif
}
