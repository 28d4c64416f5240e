"""Fewer faces for the second layer: an approximation, made only where `layers.faces` asks for it."""

from collections.abc import Mapping
from typing import Any

from fakesss.calls import no_thickness
from fakesss.frame_graph import Bake
from fakesss.knob import Knob, Level, culled, first_of
from fakesss.scene import Scene

ALL = Level("all", {"layers.faces": None})
KNOBS = (
    Knob(
        name="second-layer faces",
        levels=(*(Level(count, {"layers.faces": count}) for count in (2_000, 4_000, 8_000, 16_000)), ALL),
        reference=ALL,
        error="the second layer's shape, most at edges of near parts before far ones",
        unused=first_of(no_thickness, culled("coarse_mesh", {"layers.faces": 4})),
    ),
)


def coarse_mesh(scene: Scene) -> Bake:
    """Reads `mesh`; writes `coarse_mesh`, a `fakesss.mesh.Mesh` of about `layers.faces` faces."""
    faces = scene.layers.faces

    def make(inputs: Mapping[str, Any]) -> Any:
        from fakesss.coarser import coarser  # loads the simplifier

        return coarser(inputs["mesh"], faces or len(inputs["mesh"].faces))

    return Bake("coarse_mesh", make, key=lambda inputs: (inputs["mesh"].sha256, faces), reads=("mesh",))
