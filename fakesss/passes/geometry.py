"""Vertex data on the GPU, in eye space; a sweep that moves neither object nor camera uploads it once."""

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any, Literal

import moderngl
import numpy as np

from fakesss.camera import View
from fakesss.frame import Frame
from fakesss.mesh import Mesh

EXACT = "only uploads vertices and draws them"


@dataclass
class Upload:
    """A buffer and which version of its contents it holds."""

    buffer: Any
    version: Hashable

    def release(self) -> None:
        self.buffer.release()


Cull = Literal["", "front", "back"]
Attribute = tuple[Any, str, str]  # moderngl's (buffer, format, name)


def draw_mesh(frame: Frame, mesh: Mesh, view: View, program: Any, attributes: list[Attribute], cull: Cull = "") -> None:
    """Draw the faces but those turned as `cull` says; `in_eye` is added to the attributes."""
    context = frame.gpu.context
    positions = upload(frame, ("positions", mesh.sha256), lambda: view.to_eye(mesh.positions), view.pose)
    faces = upload(frame, ("faces", mesh.sha256), lambda: mesh.faces.astype(np.int32))
    content = [(positions, "3f", "in_eye"), *attributes]
    vertices = context.vertex_array(program, content, faces, index_element_size=4)
    if cull:
        context.cull_face = cull
        context.enable(moderngl.CULL_FACE)
    vertices.render(moderngl.TRIANGLES)
    context.disable(moderngl.CULL_FACE)
    vertices.release()


def shows_front_faces(mesh: Mesh, view: View) -> bool:
    """Whether `view` sees a closed surface whole and from outside: front faces before back faces everywhere."""
    return mesh.watertight and not view.clips_sphere


def normals(frame: Frame, view: View) -> Attribute:
    """Vertex normals in the eye frame."""
    mesh: Mesh = frame.inputs["mesh"]
    turned = upload(frame, ("normals", mesh.sha256), lambda: view.turn(mesh.normals).astype(np.float32), view.pose)
    return turned, "3f", "in_normal"


def upload(frame: Frame, key: Hashable, make: Callable[[], Any], version: Hashable = None) -> Any:
    """The buffer of `key`, filled from the array of `make` unless it holds this `version` from an earlier picture.

    Versions have the same size and overwrite each other: making a buffer for each pose of a turning camera leaves
    holes in the driver's memory that add up to gigabytes over thousands of pictures.
    """
    held = frame.gpu.uploads.get(key, lambda: Upload(frame.gpu.context.buffer(np.ascontiguousarray(make())), version))
    if held.version != version:
        held.buffer.write(np.ascontiguousarray(make()))
        held.version = version
    return held.buffer
