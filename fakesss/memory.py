"""Textures and depth buffers that a compiled graph needs, counted without a GPU."""

from collections import Counter

from fakesss.frame_graph import DEPTH, Node, Pass, Plan, TextureSpec


def written_bytes(node: Node) -> int:
    """Bytes of the textures that a pass writes; what is made on the processor or only chosen writes none."""
    return sum(spec.bytes for spec in node.writes.values()) if isinstance(node, Pass) else 0


def shadow_maps(plan: Plan) -> TextureSpec | None:
    """The texture of all shadow maps, if the plan draws one."""
    drawn = (node.writes for node in plan.kept if isinstance(node, Pass))
    return next((writes["shadow_maps"] for writes in drawn if "shadow_maps" in writes), None)


def peak_bytes(plan: Plan) -> int:
    """Bytes of all textures and depth buffers that drawing a plan once takes from an empty pool.

    As `frame.Run` does it: a texture goes back after its last reader, equal ones are taken again before new ones are
    made, and a depth buffer that a pass keeps to itself is shared by all of its size.
    """
    free: Counter[TextureSpec] = Counter()
    lent: dict[str, TextureSpec] = {}
    own_depth: set[tuple[int, int]] = set()
    total = 0
    for node in plan.kept:
        if isinstance(node, Pass):
            for name, spec in node.writes.items():
                total += 0 if free[spec] else spec.bytes
                free[spec] -= 1 if free[spec] else 0
                lent[name] = spec
            specs = list(node.writes.values())
            if node.depth_test and all(spec.components != DEPTH for spec in specs):
                own_depth.add(specs[0].size)
        for name in plan.dead_after[node.name]:
            if name in lent:
                free[lent.pop(name)] += 1
    return total + sum(TextureSpec(size, DEPTH).bytes for size in own_depth)
