// Twin of colour.decode_srgb. IEC 61966-2-1:1999.
vec3 decode_srgb(vec3 code) {
    return mix(code / 12.92, pow((code + 0.055) / 1.055, vec3(2.4)), greaterThan(code, vec3(0.04045)));
}
