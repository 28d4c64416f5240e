// Where a first interval of the baked length would end.
in float leave;
out float local_exit;

void main() {
    local_exit = leave;
}
