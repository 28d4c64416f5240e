"""Local thickness per vertex: see `fakesss.local_thickness`."""

from collections.abc import Mapping
from typing import Any

from fakesss.frame_graph import Bake
from fakesss.knob import Knob, Level, culled, levels, spread_order
from fakesss.scene import Scene

KNOBS = (
    Knob(
        name="local thickness rays",
        levels=levels("layers.rays", (8, 16, 32, 64, 128, 320, 1024, 4096)),
        reference=Level(16384, {"layers.rays": 16384}),
        error="the mean way to the other side, another at each vertex",
        unused=culled("local_thickness"),
        order=spread_order(2),  # directions
        baked="local_thickness",
    ),
)


def local_thickness(scene: Scene) -> Bake:
    """Reads `mesh`; writes `local_thickness`, whose `values` are (V,) float32 in 0..1 sphere diameters."""
    rays, reach = scene.layers.rays, scene.layers.reach

    def make(inputs: Mapping[str, Any]) -> Any:
        from fakesss.local_thickness import bake_local_thickness  # loads Embree

        return bake_local_thickness(inputs["mesh"], rays, reach)

    return Bake("local_thickness", make, key=lambda inputs: (inputs["mesh"].sha256, rays, reach), reads=("mesh",))
