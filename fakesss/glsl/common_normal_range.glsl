// Without what is too small for a float32's full precision. A driver may keep such values or take them for 0, and Mesa's
// software rasteriser changes its mind, thread by thread, after it has drawn into float16.
vec3 in_normal_range(vec3 value) { return mix(value, vec3(0.0), lessThan(abs(value), vec3(1.17549435e-38))); }
