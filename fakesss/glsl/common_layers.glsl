// Depth layers hold the depth along the view axis in sphere radii, measured from ORIGIN in front of the sphere's
// centre: what is in the sphere lies in 1..3 wherever the camera stands, and 0 means that nothing is there.
const float ORIGIN = 2.0;
const float DIAMETER = 2.0;  // of the bounding sphere, whose radius is the unit

// In a triangle smaller than a pixel, interpolation runs on beyond its corners, and so out of the sphere.
float in_sphere(float layer) { return clamp(layer, ORIGIN - 1.0, ORIGIN + 1.0); }

bool is_empty(float layer) { return layer == 0.0; }

float relative_thickness(float front, float second, float open_thickness) {
    return is_empty(second) ? open_thickness : clamp((second - front) / DIAMETER, 0.0, 1.0);
}
