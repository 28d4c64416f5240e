// Thickness to a second layer that a depth-aware Gaussian has softened: thesis section 3.1 and appendix C.2.2.
// Twin of softening.softened.
#include "common_depth.glsl"
#include "common_layers.glsl"

#define AS_PUBLISHED 0  // 1: weights from non-linear depths, background recognised by them
#define PUBLISHED_BACKGROUND 0.99  // thesis appendix C.2.2, in non-linear depth
#define TAPS 5  // 3, 5 or 9 across and down
#define ROWS 1  // 0: none but the sample's own, so that the taps are a row
#define COLUMNS 1  // 0: the same of columns
#define SECOND_STEP 0  // 1: what the row has softened already

#if SECOND_STEP
uniform sampler2D softened_across;
float layer_at(vec2 place) { return texture(softened_across, place).r; }
#else
uniform sampler2D second;
float layer_at(vec2 place) { return texture(second, place).r; }
#endif
uniform vec2 tap;           // distance between taps, shares of the layer's width and height
uniform float depth_range;  // difference at which a tap's weight reaches 0; sphere radii, or non-linear as published
#if AS_PUBLISHED
uniform vec2 clip;
uniform float distance;
#endif

// Gaussian weights by distance from the centre, see softening.py; their sum cancels.
#if TAPS == 3
const float SIDE[2] = float[](4.0, 1.0);
#elif TAPS == 9
const float SIDE[5] = float[](1.0, 0.90585269, 0.67333363, 0.41069384, 0.20555178);
#elif ROWS && COLUMNS
// the usual integer table of a Gaussian with standard deviation 1
const float TABLE[9] = float[](41.0, 26.0, 7.0,
                               26.0, 16.0, 4.0,
                                7.0,  4.0, 1.0);
#else
const float SIDE[3] = float[](107.0, 66.0, 17.0);  // sums of the table's rows
#endif

float gaussian(int x, int y) {
#if TAPS == 5 && ROWS && COLUMNS
    return TABLE[3 * abs(y) + abs(x)];
#else
    return SIDE[abs(x)] * SIDE[abs(y)];
#endif
}

#if AS_PUBLISHED
float compared(float layer) { return is_empty(layer) ? 1.0 : nonlinear_depth(layer - ORIGIN + distance, clip); }
bool is_background(float window) { return window > PUBLISHED_BACKGROUND; }
float to_layer(float window) { return linear_depth(window, clip) - distance + ORIGIN; }
#else
float compared(float layer) { return layer; }
bool is_background(float layer) { return is_empty(layer); }
float to_layer(float layer) { return layer; }
#endif

const int ACROSS = COLUMNS * (TAPS / 2);
const int DOWN = ROWS * (TAPS / 2);

float blurred(float centre, vec2 here) {
    float sum = 0.0, weights = 0.0, steepness = 1.0 / depth_range;
    for (int y = -DOWN; y <= DOWN; ++y)
        for (int x = -ACROSS; x <= ACROSS; ++x) {
            float depth = compared(layer_at(here + tap * vec2(x, y)));
            float kernel = gaussian(x, y);
            float off = depth - centre;
            // eq. C.1, g (1 - clamp(|dz| / range, 0, 1)), in one multiplication and addition
            float weight = is_background(depth) ? 0.0 : max(kernel - abs(off) * (kernel * steepness), 0.0);
            sum += weight * off;  // of differences: their rounding is far below that of depths
            weights += weight;
        }
    return to_layer(weights > 0.0 ? centre + sum / weights : centre);
}
