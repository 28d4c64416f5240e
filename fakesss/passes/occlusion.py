"""Ambient occlusion [a] per vertex, thesis section 3.1, eq. 3.5: the share of rays that hit nothing."""

from collections.abc import Mapping
from typing import Any

from fakesss.frame_graph import Bake
from fakesss.knob import Knob, Level, culled, levels, spread_order
from fakesss.scene import Scene

KNOBS = (
    Knob(
        name="occlusion rays",
        levels=levels("occlusion.rays", (8, 16, 32, 64, 128, 320, 1024, 4096)),
        reference=Level(16384, {"occlusion.rays": 16384}),
        error="the share of rays that hit nothing, another at each vertex",
        unused=culled("occlusion"),
        order=spread_order(2),  # directions
        baked="occlusion",
    ),
)


def occlusion(scene: Scene) -> Bake:
    """Reads `mesh`; writes `occlusion`, a `fakesss.occlusion.Baked` with (V,) float32 values in 0..1."""
    rays, sampling = scene.occlusion.rays, scene.occlusion.sampling

    def make(inputs: Mapping[str, Any]) -> Any:
        from fakesss.occlusion import bake_occlusion  # loads Embree, which a scene without ambient light never needs

        return bake_occlusion(inputs["mesh"], rays, sampling)

    return Bake(
        "occlusion",
        make,
        key=lambda inputs: (inputs["mesh"].sha256, rays, sampling),
        reads=("mesh",),
    )
