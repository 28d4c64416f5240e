"""The frame graph of a scene. Every node is always declared; the scene decides only what the consumers read."""

from fakesss.calls import Setting
from fakesss.camera import View
from fakesss.frame_graph import FrameGraph
from fakesss.passes.back_faces import back_faces
from fakesss.passes.blur import blur
from fakesss.passes.bridge import bridge
from fakesss.passes.coarse_mesh import coarse_mesh
from fakesss.passes.front import front
from fakesss.passes.local_exit import local_exit
from fakesss.passes.local_thickness import local_thickness
from fakesss.passes.mesh import mesh
from fakesss.passes.occlusion import occlusion
from fakesss.passes.peel import deeper, peel
from fakesss.passes.resolve import image, resolve
from fakesss.passes.screen_occlusion import sample_occlusion, screen_occlusion
from fakesss.passes.second import first_exit, second
from fakesss.passes.shade import shade
from fakesss.passes.shadow import shadow
from fakesss.passes.soften import soften, soften_across
from fakesss.passes.sparse import sparse_back_faces, upsample
from fakesss.passes.thickness import thickness
from fakesss.passes.total_path import path_exit, total_path
from fakesss.scene import Scene

NONE: frozenset[str] = frozenset()


def build(scene: Scene, samples: int = 1, solid: bool = False, forced: frozenset[str] = NONE) -> FrameGraph:
    """The graph of `scene` with `samples` x `samples` samples in a pixel of `image`; needs no GPU.

    `solid`: whether the mesh is one (`fakesss.solidity`). `forced`: effects of `calls.EFFECTS` to simulate although
    their weight is zero.
    """
    size = (scene.size[0] * samples, scene.size[1] * samples)
    setting = Setting(scene, View.of(scene.camera, scene.size), size, samples, solid, forced)
    return FrameGraph(
        [
            mesh(scene),
            occlusion(scene),
            local_thickness(scene),
            coarse_mesh(scene),
            front(setting),
            back_faces(setting),
            sparse_back_faces(setting),
            upsample(setting),
            peel(setting),
            first_exit(setting),
            *deeper(setting),
            bridge(setting),
            total_path(setting),
            path_exit(setting),
            local_exit(setting),
            second(setting),
            thickness(setting),
            soften_across(setting),
            soften(setting),
            blur(setting),
            sample_occlusion(setting),
            screen_occlusion(setting),
            shadow(setting),
            shade(setting),
            resolve(setting),
            image(setting),
        ]
    )


def samples_of(scene: Scene) -> int:
    """n of the n x n samples in a pixel; the published program had one."""
    return 1 if scene.style == "as published" else scene.supersampling
