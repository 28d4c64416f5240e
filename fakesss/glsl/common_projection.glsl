// The projection of camera.py: `eye` is (x right, y up, depth).
uniform vec2 tangent;  // of the half angles of the picture's width and height
uniform vec2 clip;     // near and far distance, sphere radii

vec4 project(vec3 eye) {
    float scale = (clip.y + clip.x) / (clip.y - clip.x);
    float offset = -2.0 * clip.y * clip.x / (clip.y - clip.x);
    return vec4(eye.xy / tangent, scale * eye.z + offset, eye.z);
}
