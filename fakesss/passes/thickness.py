"""Thickness along the view axis between the first two layers, in sphere diameters."""

from fakesss.camera import View
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.mesh import Mesh
from fakesss.scene import Scene


def thickness(scene: Scene, view: View, size: tuple[int, int]) -> Pass:
    """Reads `mesh`, `front` and `second`; writes `thickness` (0..1)."""

    def draw(frame: Frame) -> None:
        frame.fill("thickness.frag", {"open_thickness": open_thickness(frame.inputs["mesh"], scene, view)})

    return Pass("thickness", draw, reads=("mesh", "front", "second"), writes={"thickness": TextureSpec(size, 1)})


def open_thickness(mesh: Mesh, scene: Scene, view: View) -> float:
    """Thickness of a pixel with no second layer.

    A closed surface that no clip plane cuts always has one, except where it is thinner than the peel can part: 0.
    Anything else follows the scene's stated policy.
    """
    if mesh.watertight and not view.clips_sphere:
        return 0.0
    return {"thin": 0.0, "thick": 1.0}[scene.open_surface]
