"""Local thickness per vertex: see `fakesss.local_thickness`."""

from collections.abc import Mapping
from typing import Any

from fakesss.frame_graph import Bake
from fakesss.scene import Scene


def local_thickness(scene: Scene) -> Bake:
    """Reads `mesh`; writes `local_thickness`, whose `values` are (V,) float32 in 0..1 sphere diameters."""
    rays, reach = scene.layers.rays, scene.layers.reach

    def make(inputs: Mapping[str, Any]) -> Any:
        from fakesss.local_thickness import bake_local_thickness  # loads Embree

        return bake_local_thickness(inputs["mesh"], rays, reach)

    return Bake("local_thickness", make, key=lambda inputs: (inputs["mesh"].sha256, rays, reach), reads=("mesh",))
