// Twin of screen_occlusion.smoothed. The mean over one tile of rotations, every one counted alike: half of each edge of
// 5 x 5 taps, so that nothing shifts. A tap fades as its depth departs, as in common_blur.glsl.
#include "common_layers.glsl"

uniform sampler2D front;
uniform sampler2D sampled_occlusion;
uniform float depth_range;  // difference at which a tap's weight reaches 0, sphere radii

const float EDGE[3] = float[](1.0, 1.0, 0.5);

out float screen_occlusion;

void main() {
    vec2 texel = 1.0 / vec2(textureSize(front, 0));
    float centre = texelFetch(front, ivec2(gl_FragCoord.xy), 0).r;
    float sum = 0.0, weights = 0.0;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            vec2 tap = (gl_FragCoord.xy + vec2(x, y)) * texel;
            float layer = texture(front, tap).r;
            float gap = clamp(abs(layer - centre) / depth_range, 0.0, 1.0);
            float weight = is_empty(layer) ? 0.0 : EDGE[abs(x)] * EDGE[abs(y)] * (1.0 - gap);
            sum += weight * texture(sampled_occlusion, tap).r;
            weights += weight;
        }
    screen_occlusion = sum / weights;  // the tap in the middle counts 1
}
