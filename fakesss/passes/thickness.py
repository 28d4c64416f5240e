"""Thickness along the view axis between the front and the second layer, in sphere diameters."""

from collections.abc import Mapping
from typing import Any

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.mesh import Mesh
from fakesss.passes.geometry import shows_front_faces

EXACT = "subtracts two depths"


def thickness(setting: Setting) -> Pass:
    """Reads `mesh`, `front` and `second`; writes `thickness` (0..1). The shading can compute it in place."""

    def in_place(inputs: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, int]]:
        return {"open_thickness": open_thickness(inputs["mesh"], setting)}, {}

    def draw(frame: Frame) -> None:
        frame.fill("thickness.frag", in_place(frame.inputs)[0])

    return Pass(
        "thickness",
        draw,
        reads=("mesh", "front", "second", "coverage"),
        writes={"thickness": TextureSpec(setting.size, 1)},
        mask="coverage",
        in_place=in_place,
    )


def open_thickness(mesh: Mesh, setting: Setting) -> float:
    """Thickness of a pixel with no second layer.

    A closed surface that no clip plane cuts always has one, except where it is thinner than the peel can part: 0.
    Anything else follows the scene's stated policy.
    """
    if shows_front_faces(mesh, setting.view):
        return 0.0
    return {"thin": 0.0, "thick": 1.0}[setting.scene.open_surface]
