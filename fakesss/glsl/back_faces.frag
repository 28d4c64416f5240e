// The nearest of the faces that are drawn: with front faces culled, where light leaves a solid first.
in float layer;
out float nearest_back;

void main() {
    nearest_back = layer;
}
