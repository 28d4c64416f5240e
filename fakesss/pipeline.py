"""The frame graph of a scene. Every node is always declared; the scene decides only what the consumers read."""

from fakesss.camera import View
from fakesss.frame_graph import FrameGraph
from fakesss.passes.blur import blur
from fakesss.passes.front import front
from fakesss.passes.mesh import mesh
from fakesss.passes.occlusion import occlusion
from fakesss.passes.resolve import resolve
from fakesss.passes.second import second
from fakesss.passes.shade import shade
from fakesss.passes.thickness import thickness
from fakesss.scene import Scene


def build(scene: Scene, samples: int = 1) -> FrameGraph:
    """The graph of `scene` with `samples` x `samples` samples in a pixel of `image`; needs no GPU."""
    size = (scene.size[0] * samples, scene.size[1] * samples)
    view = View.of(scene.camera, scene.size)
    return FrameGraph(
        [
            mesh(scene),
            occlusion(scene),
            front(scene, view, size),
            second(scene, view, size),
            thickness(scene, view, size),
            blur(scene, view, size),
            shade(scene, view, size),
            resolve(scene, samples),
        ]
    )


def samples_of(scene: Scene) -> int:
    """n of the n x n samples in a pixel; the published program had one."""
    return 1 if scene.style == "as published" else scene.supersampling
