"""Vertex data on the GPU, in eye space; a sweep that moves neither object nor camera uploads it once."""

from collections.abc import Callable, Hashable
from typing import Any

import moderngl
import numpy as np

from fakesss.camera import View
from fakesss.frame import Frame
from fakesss.mesh import Mesh

Attribute = tuple[Any, str, str]  # moderngl's (buffer, format, name)


def draw_mesh(frame: Frame, view: View, program: Any, attributes: list[Attribute]) -> None:
    """Draw all faces; `in_eye` is added to the attributes."""
    mesh: Mesh = frame.inputs["mesh"]
    positions = upload(frame, ("positions", mesh.sha256, view.pose), lambda: view.to_eye(mesh.positions))
    faces = upload(frame, ("faces", mesh.sha256), lambda: mesh.faces.astype(np.int32))
    content = [(positions, "3f", "in_eye"), *attributes]
    vertices = frame.gpu.context.vertex_array(program, content, faces, index_element_size=4)
    vertices.render(moderngl.TRIANGLES)
    vertices.release()


def normals(frame: Frame, view: View) -> Attribute:
    """Vertex normals in the eye frame."""
    mesh: Mesh = frame.inputs["mesh"]
    key = ("normals", mesh.sha256, view.pose)
    return upload(frame, key, lambda: view.turn(mesh.normals).astype(np.float32)), "3f", "in_normal"


def upload(frame: Frame, key: Hashable, make: Callable[[], Any]) -> Any:
    """The buffer of `key`, filled from the array of `make` unless it is there from an earlier picture."""
    return frame.gpu.uploads.get(key, lambda: frame.gpu.context.buffer(np.ascontiguousarray(make()).tobytes()))
