"""The nearest surface: its depth, normal and occlusion. What is visible is decided here, once."""

import numpy as np

from fakesss.camera import View
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.passes.geometry import Attribute, draw_mesh, normals, upload
from fakesss.scene import Scene


def front(scene: Scene, view: View, size: tuple[int, int]) -> Pass:
    """Writes `front` (depth, see common_layers.glsl) and `surface` (unit normal in the eye frame, occlusion)."""
    lacking = no_occlusion_because(scene)

    def draw(frame: Frame) -> None:
        program = frame.program("front.vert", "front.frag", view.projection, {})
        draw_mesh(frame, view, program, [normals(frame, view), occlusion(frame, scene)])

    return Pass(
        "front",
        draw,
        reads=("mesh",) if lacking else ("mesh", "occlusion"),
        unread={"occlusion": lacking} if lacking else {},
        only_for={"occlusion": "surface"},
        writes={"front": TextureSpec(size, 1), "surface": TextureSpec(size, 4)},
        depth_test=True,
    )


def no_occlusion_because(scene: Scene) -> str:
    """Why the ambient term needs no bake, or nothing if it does."""
    if not scene.occlusion.enabled:
        return "occlusion.enabled is false"
    if not any(scene.light.ambient):
        return "light.ambient is 0"
    return "" if scene.material.ambient else "material.ambient is 0"


def occlusion(frame: Frame, scene: Scene) -> Attribute:
    """Baked occlusion per vertex; without it every vertex sees the whole hemisphere."""
    mesh = frame.inputs["mesh"]
    if "occlusion" not in frame.inputs:
        key = ("open", len(mesh.positions))
        return upload(frame, key, lambda: np.ones(len(mesh.positions), np.float32)), "1f", "in_occlusion"
    baked = ("occlusion", mesh.sha256, scene.occlusion.rays, scene.occlusion.sampling)
    values = frame.inputs["occlusion"].values
    return upload(frame, baked, lambda: values), "1f", "in_occlusion"
