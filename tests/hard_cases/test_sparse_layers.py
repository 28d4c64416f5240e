"""Hard cases with the second layer at every n-th sample, in half floats, with every kernel: finite, and no seams."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from catalogue import DRAWN
from edges import off_edges
from hard_case import Case
from terms import range_of

from fakesss.renderer import Renderer

pytestmark = pytest.mark.gl

SEEN_FROM_OUTSIDE = [
    "needle", "thin-plate", "tilted-thin-plate", "many-triangles", "four-triangles", "cubes-on-an-edge",
    "cones-at-a-point", "both-sides-of-a-sheet", "nested-shells", "coincident-shells", "camera-behind",
    "camera-at-the-pole", "narrowest-view", "widest-view", "one-pixel", "one-row", "one-column", "odd-size",
    "widest-blur", "narrowest-blur", "four-face-layer",
]  # fmt: skip
HARD = [DRAWN[name] for name in SEEN_FROM_OUTSIDE]
OTHERS = [
    DRAWN[name] for name in ("open-sheet", "opaque-sheet", "pages", "camera-inside", "near-plane-cuts", "bridged")
]
CHEAP: list[dict[str, Any]] = [
    {"layers.resolution": 2},
    {"layers.resolution": 4, "blur.enabled": False},
    {"layers.resolution": 2, "blur.kernel": "separable", "layers.depth": "float16"},
    {"layers.depth": "float16", "blur.kernel": "9x9"},
]
# Off the edges and folds, sphere diameters: 99th percentile, and the share beyond 0.05, which makes a seam.
OFF, SEAM = 0.02, 4e-3


@pytest.mark.parametrize("changes", CHEAP, ids=str)
@pytest.mark.parametrize("case", [*HARD, *OTHERS], ids=str)
def test_every_pixel_is_finite_and_within_its_terms(
    renderer: Renderer, folder: Path, case: Case, changes: dict[str, Any]
) -> None:
    scene = case.scene(folder).replace(changes)
    drawn = renderer.render(scene)
    assert drawn.non_finite == 0
    low, high = range_of(scene)
    slack, colour, coverage = 1e-5 * max(1, *np.abs(low), *high), drawn.image[..., :3], drawn.image[..., 3:]
    object_only = colour - (1 - coverage) * np.array(scene.background)
    assert (object_only >= coverage * low - slack).all() and (object_only <= coverage * high + slack).all()
    layers = renderer.data(scene, ("front", "thickness", "blurred_thickness"))
    for name in ("thickness", "blurred_thickness"):
        assert np.isfinite(layers[name]).all() and layers[name].min() >= 0 and layers[name].max() <= 1
        assert not layers[name][layers["front"] == 0].any()


@pytest.mark.parametrize("case", HARD, ids=str)
def test_no_seams_off_the_edges(renderer: Renderer, folder: Path, case: Case) -> None:
    """Where the exact layers have no edge, the sparse one makes none."""
    scene = case.scene(folder).replace({"supersampling": 1})
    names = ("front", "second", "surface", "thickness")
    exact = renderer.data(scene, names)
    sparse = renderer.data(scene.replace({"layers.resolution": 2}), ("thickness",))["thickness"]
    error = np.abs(sparse - exact["thickness"])[off_edges(exact, 2)]
    if error.size:
        assert np.percentile(error, 99) < OFF and (error > 0.05).mean() < SEAM
