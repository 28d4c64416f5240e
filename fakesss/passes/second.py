"""The second layer: the nearest surface behind the front layer, by one step of depth peeling."""

from fakesss.camera import View
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.passes.geometry import draw_mesh
from fakesss.scene import Scene


def second(scene: Scene, view: View, size: tuple[int, int]) -> Pass:
    """Reads `mesh` and `front`; writes `second` (depth, see common_layers.glsl; 0 where there is none)."""
    published = int(scene.style == "as published")

    def draw(frame: Frame) -> None:
        program = frame.program("second.vert", "second.frag", view.projection, {"AS_PUBLISHED": published})
        draw_mesh(frame, view, program, [])

    return Pass("second", draw, reads=("mesh", "front"), writes={"second": TextureSpec(size, 1)}, depth_test=True)
