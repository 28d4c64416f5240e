// Twin of sparse_layer.upsampled. A layer known at every n-th sample, at all of them: the mean of the four around,
// those preferred whose front layer is near in depth (Kopf, Cohen, Lischinski and Uyttendaele, Joint bilateral
// upsampling, 2007). One that lies before the front layer is another part's and counts nothing: without this, dots
// show along edges of near parts before far ones.
#include "common_layers.glsl"

#define EVERY 2  // n
#define STEEPEST 8.0  // rise from texel to texel, in their width: front layers farther apart belong to different parts
#define LEAST 1e-4  // of a weight, so that whoever is left is taken

uniform float texel_width;  // at the sphere's centre, sphere radii

// 0 where none of the four has a second layer behind `z1`, which is the front layer at `place`.
float upsampled(sampler2D layer, sampler2D front, float z1, vec2 place) {
    vec2 samples = vec2(textureSize(front, 0)), texels = vec2(textureSize(layer, 0));
    vec2 at = floor(place * samples) / float(EVERY);
    vec2 corner = floor(at), share = at - corner;
    float sum = 0.0, weights = 0.0;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) {
            vec2 texel = min(corner + vec2(x, y), texels - 1.0);
            float z2 = texture(layer, (texel + 0.5) / texels).r;
            float guide = texture(front, (texel * float(EVERY) + 0.5) / samples).r;
            vec2 side = abs(1.0 - vec2(x, y) - share);
            float near = max(side.x * side.y, LEAST);
            float alike = max(1.0 - abs(guide - z1) / (STEEPEST * texel_width), LEAST);
            // a thin plate's own back, seen at up to 45 degrees, may lie so far before its front one texel away
            float weight = is_empty(z2) || z2 < z1 - texel_width ? 0.0 : near * alike;
            sum += weight * (z2 - z1);
            weights += weight;
        }
    return weights > 0.0 ? z1 + max(sum / weights, 0.0) : 0.0;
}
