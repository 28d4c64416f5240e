"""Layers behind the front one, by depth peeling: each is the nearest surface behind the one before."""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass
from fakesss.passes.geometry import Cull, draw_mesh, shows_front_faces
from fakesss.passes.layer import is_half, layer

EXACT = "looks at every fragment; what lies within 1e-5 diameters of a layer is that layer"

DEEPEST = 6  # layer of a bridged thickness: three stretches of matter in a solid


def peel(setting: Setting) -> Pass:
    """Reads `mesh` and `front`; writes `peeled` (depth of the second layer, 0 where there is none)."""

    def draw(frame: Frame) -> None:
        front_faces = int(shows_front_faces(frame.inputs["mesh"], setting.view))
        published = int(setting.published)
        step(frame, setting, "front", "", BEFORE_FACES=front_faces, NEAREST=1, AS_PUBLISHED=published)

    return Pass(
        "peel",
        draw,
        reads=("mesh", "front"),
        writes={"peeled": layer(setting)},
        depth_test=True,
    )


def deeper(setting: Setting) -> list[Pass]:
    """One pass for each layer from the second on: writes `layer_2` and so on, negative where it is of a front face.

    In a solid, entries and exits alternate, so only faces turned the right way need to be drawn.
    """

    def one(number: int) -> Pass:
        """The layer of this number."""
        before = "front" if number == 2 else f"layer_{number - 1}"
        faces: Cull = ("front" if number % 2 == 0 else "back") if setting.outside_only else ""

        def draw(frame: Frame) -> None:
            known = int(shows_front_faces(frame.inputs["mesh"], setting.view)) if number == 2 else 2
            step(frame, setting, before, faces, BEFORE_FACES=known, NEAREST=int(number == 2), SIGNED=1)

        return Pass(
            f"peel_{number}",
            draw,
            reads=("mesh", before),
            writes={f"layer_{number}": layer(setting)},
            depth_test=True,
        )

    return [one(number) for number in range(2, DEEPEST + 1)]


def step(frame: Frame, setting: Setting, before: str, cull: Cull, **defines: int) -> None:
    """Draw what lies behind the layer `before`."""
    view = setting.view
    compared = {"clip": (view.near, view.far)} if defines.get("AS_PUBLISHED") else {}
    all_defines = {"HALF": is_half(setting), **defines}
    program = frame.program("layer.vert", "peel.frag", {**view.projection, **compared}, all_defines, {before: "before"})
    draw_mesh(frame, frame.inputs["mesh"], view, program, [], cull)
