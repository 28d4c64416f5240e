"""The nearest surface: its depth, normal and occlusion. What is visible is decided here, once."""

import numpy as np

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import DEPTH, Pass, TextureSpec
from fakesss.passes.geometry import Attribute, draw_mesh, normals, upload
from fakesss.passes.layer import layer
from fakesss.scene import Scene

EXACT = "draws every face at every sample; its buffers hold float32"


def front(setting: Setting) -> Pass:
    """Writes `front` (depth, see common_layers.glsl), `surface` (unit normal in the eye frame, baked occlusion) and
    `coverage`, the depth buffer that keeps full-screen passes to the object."""
    lacking = no_bake_because(setting)
    view, size = setting.view, setting.size

    def draw(frame: Frame) -> None:
        program = frame.program("front.vert", "front.frag", view.projection, {})
        attributes = [normals(frame, view), occlusion(frame, setting.scene)]
        draw_mesh(frame, frame.inputs["mesh"], view, program, attributes, "back" if setting.outside_only else "")

    return Pass(
        "front",
        draw,
        reads=("mesh",) if lacking else ("mesh", "occlusion"),
        unread={"occlusion": lacking} if lacking else {},
        only_for={"occlusion": "surface"},
        writes={"front": layer(setting), "surface": TextureSpec(size, 4), "coverage": TextureSpec(size, DEPTH)},
        read_masked=("surface",),
        depth_test=True,
    )


def no_bake_because(setting: Setting) -> str:
    """Why the ambient term needs no bake, or nothing if it does."""
    if setting.scene.occlusion.method != "baked":
        return setting.lacking("occlusion") or 'occlusion.method is "screen-space"'
    return setting.lacking("occlusion")


def occlusion(frame: Frame, scene: Scene) -> Attribute:
    """Baked occlusion per vertex; without it every vertex sees the whole hemisphere."""
    mesh = frame.inputs["mesh"]
    if "occlusion" not in frame.inputs:
        key = ("open", len(mesh.positions))
        return upload(frame, key, lambda: np.ones(len(mesh.positions), np.float32)), "1f", "in_occlusion"
    baked = ("occlusion", mesh.sha256, scene.occlusion.rays, scene.occlusion.sampling)
    values = frame.inputs["occlusion"].values
    return upload(frame, baked, lambda: values), "1f", "in_occlusion"
