// Depth layers hold the depth along the view axis in sphere radii; 0 means that nothing is there, since every drawn
// fragment lies beyond the near plane.
const float DIAMETER = 2.0;  // of the bounding sphere, whose radius is the unit

bool is_empty(float depth) { return depth == 0.0; }

float relative_thickness(float front, float second, float open_thickness) {
    return is_empty(second) ? open_thickness : clamp((second - front) / DIAMETER, 0.0, 1.0);
}
