"""The whole way through matter behind a pixel: the sum of back depths minus the sum of front depths.

Additive blending, so one draw in any order. Where a surface does not close behind a pixel (as many exits as entries),
the sum means nothing, and the pixel has no second layer.
"""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.passes.geometry import draw_mesh
from fakesss.passes.layer import layer

EXACT = "adds up every face's depth in float32"


def total_path(setting: Setting) -> Pass:
    """Reads `mesh`; writes `path`: (depth of exits less depth of entries in sphere radii, exits less entries)."""

    def draw(frame: Frame) -> None:
        program = frame.program("layer.vert", "total_path.frag", setting.view.projection, {})
        draw_mesh(frame, frame.inputs["mesh"], setting.view, program, [])

    return Pass("total_path", draw, reads=("mesh",), writes={"path": TextureSpec(setting.size, 2)}, add=True)


def path_exit(setting: Setting) -> Pass:
    """Reads `front` and `path`; writes `path_exit`: the depth at which so long a first interval would end."""

    def draw(frame: Frame) -> None:
        frame.fill("path_exit.frag", {})

    return Pass(
        "path_exit",
        draw,
        reads=("front", "path", "coverage"),
        writes={"path_exit": layer(setting)},
        mask="coverage",
    )
