"""Thickness to a softened second layer, so that its edges do not show through as hard lines."""

from fakesss.camera import View
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.passes.thickness import open_thickness
from fakesss.scene import Scene

PUBLISHED_STEP = 1 / 256  # of the viewport, thesis appendix C.2.1
PUBLISHED_RANGE = 0.10  # of non-linear depth, thesis eq. C.1


def blur(scene: Scene, view: View, size: tuple[int, int]) -> Pass:
    """Reads `mesh`, `front` and `second`; writes `blurred_thickness` (0..1)."""
    published = scene.style == "as published"
    uniforms = {
        "tap": (PUBLISHED_STEP, PUBLISHED_STEP) if published else view.in_picture(2 * scene.blur.step),
        "depth_range": PUBLISHED_RANGE if published else 2 * scene.blur.depth_range,
        **({"clip": (view.near, view.far), "distance": view.distance} if published else {}),
    }

    def draw(frame: Frame) -> None:
        policy = open_thickness(frame.inputs["mesh"], scene, view)
        frame.fill("blur.frag", {**uniforms, "open_thickness": policy}, AS_PUBLISHED=int(published))

    writes = {"blurred_thickness": TextureSpec(size, 1)}
    return Pass("blur", draw, reads=("mesh", "front", "second"), writes=writes)
