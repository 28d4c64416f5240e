// Depth along the map's axis, sphere radii: from the sphere's centre, or from a light with six maps.
in float depth;
out float shadow_maps;

void main() {
    shadow_maps = depth;
}
