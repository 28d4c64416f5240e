"""Fewer faces for the second layer: an approximation, made only where `layers.faces` asks for it."""

from collections.abc import Mapping
from typing import Any

from fakesss.frame_graph import Bake
from fakesss.scene import Scene


def coarse_mesh(scene: Scene) -> Bake:
    """Reads `mesh`; writes `coarse_mesh`, a `fakesss.mesh.Mesh` of about `layers.faces` faces."""
    faces = scene.layers.faces

    def make(inputs: Mapping[str, Any]) -> Any:
        from fakesss.coarser import coarser  # loads the simplifier

        return coarser(inputs["mesh"], faces or len(inputs["mesh"].faces))

    return Bake("coarse_mesh", make, key=lambda inputs: (inputs["mesh"].sha256, faces), reads=("mesh",))
