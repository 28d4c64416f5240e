"""The second layer of a solid, in one pass: its nearest back face.

Light enters a solid through a front face and leaves it through the next back face. Seen from outside, no back face
lies before the first front face, so the nearest one is where the first interval ends.
"""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.passes.geometry import draw_mesh

EXACT = "draws every back face at every sample; which faces and how many samples are knobs of other modules"


def back_faces(setting: Setting) -> Pass:
    """Reads `mesh`, or `coarse_mesh` where `layers.faces` asks for it; writes `nearest_back` (depth)."""
    coarse = setting.scene.layers.faces is not None

    def draw(frame: Frame) -> None:
        mesh = frame.inputs["coarse_mesh" if coarse else "mesh"]
        program = frame.program("layer.vert", "back_faces.frag", setting.view.projection, {})
        draw_mesh(frame, mesh, setting.view, program, [], "front")

    return Pass(
        "back_faces",
        draw,
        reads=("coarse_mesh",) if coarse else ("mesh",),
        unread={} if coarse else {"coarse_mesh": "layers.faces is not set"},
        writes={"nearest_back": TextureSpec(setting.size, 1)},
        depth_test=True,
    )
