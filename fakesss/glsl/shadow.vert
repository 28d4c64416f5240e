// The object as a light sees it: see shadow_maps.py.
in vec3 in_eye;  // (right, up, beyond the sphere's centre) as the camera sees it

uniform mat3 turn;     // to the map's (right, up, away)
uniform vec3 centre;   // of the sphere, there
uniform vec3 opening;  // width w = x + y depth; half width of the map / w
uniform vec4 ends;     // depths that the map spans, and the widths there

out float depth;

void main() {
    vec3 seen = turn * in_eye + centre;
    depth = seen.z;
    float window = (ends.w * (seen.z - ends.x) - ends.z * (ends.y - seen.z)) / (ends.y - ends.x);
    gl_Position = vec4(seen.xy / opening.z, window, opening.x + opening.y * seen.z);
}
