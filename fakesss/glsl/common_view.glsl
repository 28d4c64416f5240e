// The camera's rays. `place` is shares of the picture's width and height.
#include "common_layers.glsl"

uniform vec2 tangent;  // of the half angles of the picture's width and height

vec3 to_viewer(vec2 place) {
    return normalize(vec3((1.0 - 2.0 * place) * tangent, 1.0));
}

// Eye-frame point, sphere radii from the sphere's centre, of a layer seen from `camera_distance` off the centre.
vec3 position(float layer, vec2 place, float camera_distance) {
    float beyond = layer - ORIGIN;
    return vec3((2.0 * place - 1.0) * tangent * (camera_distance + beyond), -beyond);
}
