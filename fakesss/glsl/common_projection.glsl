// The projection of camera.View. `eye` is (x right, y up, depth beyond the sphere's centre): measured from the centre,
// depths keep float32's full precision however far away the camera stands.
uniform vec2 tangent;    // of the half angles of the picture's width and height
uniform vec2 planes;     // distances of the near and far plane that the depth buffer spans, sphere radii
uniform vec2 room;       // from the near plane to the centre, from the centre to the far plane
uniform float distance;  // of the centre

vec4 project(vec3 eye) {
    float beyond_near = room.x + eye.z;
    float before_far = room.y - eye.z;
    float z = (planes.y * beyond_near - planes.x * before_far) / (room.x + room.y);
    return vec4(eye.xy / tangent, z, distance + eye.z);
}
