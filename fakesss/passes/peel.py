"""Layers behind the front one, by depth peeling: each is the nearest surface behind the one before."""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.passes.geometry import Cull, draw_mesh

DEEPEST = 6  # layer of a bridged thickness: three intervals of matter


def peel(setting: Setting) -> Pass:
    """Reads `mesh` and `front`; writes `peeled` (depth of the second layer, 0 where there is none)."""

    def draw(frame: Frame) -> None:
        # from outside, a closed surface shows front faces only
        closed = frame.inputs["mesh"].watertight and not setting.view.clips_sphere
        published = int(setting.published)
        step(frame, setting, "front", "", BEFORE_FACES=int(closed), NEAREST=1, AS_PUBLISHED=published)

    return Pass(
        "peel",
        draw,
        reads=("mesh", "front"),
        writes={"peeled": TextureSpec(setting.size, 1)},
        depth_test=True,
    )


def deeper(setting: Setting) -> list[Pass]:
    """One pass for each of the layers from the third on: writes `layer_3` and so on, each read by the next.

    In a solid, entries and exits alternate, so only faces turned the right way need to be drawn.
    """

    def one(number: int) -> Pass:
        before = "first_exit" if number == 3 else f"layer_{number - 1}"
        faces: Cull = ("front" if number % 2 == 0 else "back") if setting.outside_only else ""
        before_faces = (1 if number % 2 == 0 else -1) if setting.outside_only else 0
        return Pass(
            f"peel_{number}",
            lambda frame: step(frame, setting, before, faces, BEFORE_FACES=before_faces),
            reads=("mesh", before),
            writes={f"layer_{number}": TextureSpec(setting.size, 1)},
            depth_test=True,
        )

    return [one(number) for number in range(3, DEEPEST + 1)]


def step(frame: Frame, setting: Setting, before: str, cull: Cull, **defines: int) -> None:
    """Draw what lies behind the layer `before`."""
    view = setting.view
    compared = {"clip": (view.near, view.far)} if defines.get("AS_PUBLISHED") else {}
    program = frame.program("layer.vert", "peel.frag", {**view.projection, **compared}, defines, {before: "before"})
    draw_mesh(frame, frame.inputs["mesh"], view, program, [], cull)
