// Twin of camera.nonlinear_depth and camera.linear_depth. `clip` is (near, far).
float nonlinear_depth(float depth, vec2 clip) {
    return clip.y * (depth - clip.x) / (depth * (clip.y - clip.x));
}

float linear_depth(float window, vec2 clip) {
    return clip.x * clip.y / (clip.y - window * (clip.y - clip.x));  // thesis eq. 3.3
}
