// Twin of brdf.py. Gascons, Fast simulation of translucent objects, 2011.

// base^exponent for base, exponent >= 0 with 0^0 = 1; GLSL's pow() leaves a base of 0 to the driver.
float power(float base, float exponent) {
    return base > 0.0 ? pow(base, exponent) : float(exponent == 0.0);
}

float lambert(float n_dot_l) {
    return max(n_dot_l, 0.0);  // eq. 3.8
}

float blinn_phong(float n_dot_l, float n_dot_h, float shininess) {
    return n_dot_l > 0.0 ? power(max(n_dot_h, 0.0), shininess) : 0.0;  // eq. 3.9
}

float backlight(float thickness, float exponent) {
    return power(1.0 - clamp(thickness, 0.0, 1.0), exponent);  // eq. 3.10
}
