"""Direct light alone, drawn as cheaply as we know how: the yardstick of `fakesss bench`, never of a picture.

One forward pass into an 8-bit target, one light, no frame graph: what a researcher's own few lines of OpenGL would do.
"""

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View, direction
from fakesss.gpu import Gpu
from fakesss.mesh import Mesh
from fakesss.scene import Scene
from fakesss.shader_source import Programs, feed


class DirectLight:
    """Draws `scene` without backlight, to its finished picture on the GPU: `DirectLight(...)(cull=True)`.

    `occlusion` is baked, (V,). The scene has one directional light and one sample a pixel.
    """

    def __init__(self, gpu: Gpu, scene: Scene, mesh: Mesh, occlusion: NDArray[np.float32]) -> None:
        context, view = gpu.context, View.of(scene.camera, scene.size)
        self.context, self.scene = context, scene
        self.target = context.framebuffer([context.texture(scene.size, 4)], context.depth_renderbuffer(scene.size))
        program: Any = Programs(context).get("direct.vert", "direct.frag")  # its own: it lives as long as this
        feed(program, {**view.projection, **light_uniforms(scene, view)})
        content = [
            (context.buffer(np.ascontiguousarray(view.to_eye(mesh.positions))), "3f", "in_eye"),
            (context.buffer(view.turn(mesh.normals).astype(np.float32)), "3f", "in_normal"),
            (context.buffer(occlusion), "1f", "in_occlusion"),
        ]
        faces = context.buffer(np.ascontiguousarray(mesh.faces, np.int32))
        self.vertices = context.vertex_array(program, content, faces, index_element_size=4)

    def __call__(self, cull: bool = True) -> None:
        """One picture, waited for; `cull`: without the faces that are turned away."""
        flags = moderngl.DEPTH_TEST | (moderngl.CULL_FACE if cull else moderngl.NOTHING)
        self.context.cull_face = "back"
        self.target.use()
        self.context.enable_only(flags)
        self.target.clear(*self.scene.background)
        self.vertices.render(moderngl.TRIANGLES)
        self.context.enable_only(moderngl.NOTHING)
        self.context.finish()

    def image(self) -> NDArray[np.float32]:
        """The picture last drawn, (H, W, 3) linear RGB in steps of 1/255, top row first."""
        width, height = self.scene.size
        codes = np.frombuffer(self.target.read(components=3, alignment=1), np.uint8).reshape(height, width, 3)
        return np.asarray(codes[::-1] / np.float32(255), np.float32)


def light_uniforms(scene: Scene, view: View) -> dict[str, Any]:
    """What `direct.frag` needs: equation 3.7 to 3.9, multiplied out."""
    material, light = scene.material, scene.light
    reflectance = np.array(material.diffuse)
    highlight = material.specular_contribution * material.specular * np.array(light.specular)
    return {
        "size": tuple(map(float, scene.size)),
        "to_light": tuple(view.rotation @ direction(light.azimuth, light.elevation)),
        "ambient_colour": tuple(material.ambient * reflectance * light.ambient),
        "diffuse_colour": tuple(material.diffuse_contribution * reflectance * light.diffuse),
        "specular_colour": tuple(highlight),
        "shininess": material.shininess,
        "exposure": scene.exposure,
    }
