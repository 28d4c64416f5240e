"""A thickness baked into the surface instead of measured along the view: the same from wherever one looks."""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass
from fakesss.passes.geometry import draw_mesh, upload
from fakesss.passes.layer import layer

EXACT = "draws what is baked; the bake has the knob"


def local_exit(setting: Setting) -> Pass:
    """Reads `mesh` and `local_thickness`; writes `local_exit`: the depth at which so long an interval ends."""
    layers = setting.scene.layers

    def draw(frame: Frame) -> None:
        mesh, baked = frame.inputs["mesh"], frame.inputs["local_thickness"]
        key = ("local_thickness", mesh.sha256, layers.rays, layers.reach)
        attribute = upload(frame, key, lambda: baked.values), "1f", "in_thickness"
        program = frame.program("local_exit.vert", "local_exit.frag", setting.view.projection, {})
        draw_mesh(frame, mesh, setting.view, program, [attribute], "back" if setting.outside_only else "")

    return Pass(
        "local_exit",
        draw,
        reads=("mesh", "local_thickness"),
        writes={"local_exit": layer(setting)},
        depth_test=True,
    )
