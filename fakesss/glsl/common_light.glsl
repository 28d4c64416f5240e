// Twin of illumination.py: what reaches a point from a light.
#include "common_brdf.glsl"

#define NEAREST 1e-3  // sphere radii; a light nearer than that fades as its distance to the point goes to 0
#define LEAST_DIVISOR 1e-6  // of attenuation: at most a millionfold light, so that products stay within float32
#define CONE_EDGE 0.1  // share of a cone's 1 - cos in which an exponent fall-off fades out

float attenuation(float d, vec3 k) {
    return 1.0 / max(k.x + d * (k.y + d * k.z), LEAST_DIVISOR);
}

// 1 - cos of the angle between unit vectors, exact also where the cosine rounds to 1.
float versine(vec3 a, vec3 b) {
    vec3 apart = a - b;
    return 0.5 * dot(apart, apart);
}

// `v` is 1 - cos of the angle off the axis, `edge` that of the cone's half angle.
float spot_exponent(float v, float edge, float exponent) {
    float inner = clamp((edge - v) / (CONE_EDGE * edge), 0.0, 1.0);
    return power(max(1.0 - v, 0.0), exponent) * inner * inner * (3.0 - 2.0 * inner);
}

float spot_linear(float v, float edge) {
    return max(edge - v, 0.0) / edge;
}
