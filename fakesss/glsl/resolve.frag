// Box filter over n x n samples in linear light; alpha is the share covered.
#include "common_colour.glsl"
#include "common_normal_range.glsl"

#define SAMPLES 1  // n
#define AS_PUBLISHED 0  // 1: radiance was written to the screen without encoding; image is the light such a screen shows

uniform sampler2D shaded;

out vec4 image;

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * SAMPLES;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < SAMPLES; ++y)
        for (int x = 0; x < SAMPLES; ++x) {
            vec4 taken = texelFetch(shaded, corner + ivec2(x, y), 0);
#if AS_PUBLISHED
            if (taken.a > 0.0) taken.rgb = decode_srgb(clamp(taken.rgb, 0.0, 1.0));
#endif
            sum += taken;
        }
    image = sum / float(SAMPLES * SAMPLES);
    image.rgb = in_normal_range(image.rgb);
}
