"""The second layer of a solid, in one pass: its nearest back face.

Light enters a solid through a front face and leaves it through the next back face. Seen from outside, no back face
lies before the first front face, so the nearest one is where the first interval ends.
"""

from typing import Any

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass
from fakesss.passes.geometry import draw_mesh
from fakesss.passes.layer import layer

EXACT = "draws every back face at every sample; which faces and how many samples are knobs of other modules"


def back_faces(setting: Setting) -> Pass:
    """Reads `mesh`, or `coarse_mesh` where `layers.faces` asks for it; writes `nearest_back` (depth)."""

    def draw(frame: Frame) -> None:
        program = frame.program("layer.vert", "back_faces.frag", setting.view.projection, {})
        draw_mesh(frame, frame.inputs[source(setting)], setting.view, program, [], "front")

    return Pass(
        "back_faces",
        draw,
        **faces_of(setting),
        writes={"nearest_back": layer(setting)},
        depth_test=True,
    )


def source(setting: Setting) -> str:
    """The mesh that the second layer is drawn from."""
    return "mesh" if setting.scene.layers.faces is None else "coarse_mesh"


def faces_of(setting: Setting) -> dict[str, Any]:
    """What a pass that draws back faces reads, and why not something else: arguments of `Pass`."""
    if source(setting) == "coarse_mesh":
        return {"reads": ("coarse_mesh",)}
    return {"reads": ("mesh",), "unread": {"coarse_mesh": "layers.faces is not set"}}
