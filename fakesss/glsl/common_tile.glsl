// Rotations that differ from pixel to pixel, as a tile of 4 x 4 that repeats over the picture.
const float TURN = 6.28318530718;
const vec2 GOLDEN = vec2(-0.73736887808, 0.67549029426);  // cosine and sine of the golden angle, 2.39996 rad

// In sixteenths of a turn: neighbours turn far apart (Bayer, 1973).
const float TILE[16] = float[](0.0,  8.0,  2.0, 10.0,
                              12.0,  4.0, 14.0,  6.0,
                               3.0, 11.0,  1.0,  9.0,
                              15.0,  7.0, 13.0,  5.0);

float tile_share(ivec2 here) { return TILE[4 * (here.y & 3) + (here.x & 3)] / 16.0; }  // of a turn

vec2 tile_rotation(ivec2 here) {
    float angle = TURN * tile_share(here);
    return vec2(cos(angle), sin(angle));
}

vec2 by_golden_angle(vec2 v) { return mat2(GOLDEN.x, GOLDEN.y, -GOLDEN.y, GOLDEN.x) * v; }
