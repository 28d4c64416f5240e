"""What every case that is drawn must give: finite values, within the terms, the surface taken for what it is."""

from pathlib import Path

import numpy as np
import pytest
from catalogue import DRAWN
from hard_case import Case
from terms import range_of

from fakesss.renderer import Renderer

pytestmark = pytest.mark.gl

ROUNDING = 1e-5  # of the sum of the terms
NO_OBJECT = "No pixel shows the object; check camera.distance, camera.near and camera.far."


@pytest.mark.parametrize("case", DRAWN.values(), ids=str)
def test_every_pixel_is_finite_and_within_its_terms(renderer: Renderer, folder: Path, case: Case) -> None:
    scene = case.scene(folder)
    drawn = renderer.render(scene)
    colour, coverage = drawn.image[..., :3].astype(np.float64), drawn.image[..., 3:].astype(np.float64)
    assert drawn.non_finite == 0 and np.isfinite(drawn.image).all()
    assert colour.shape[:2] == scene.size[::-1]
    assert coverage.min() >= 0 and coverage.max() <= 1
    low, high = range_of(scene)
    object_only = colour - (1 - coverage) * np.array(scene.background)
    slack = ROUNDING * max(1, *np.abs(low), *high)
    shown = coverage[..., 0] > 0
    assert (object_only >= coverage * low - slack).all()
    assert (object_only[shown] <= coverage[shown] * high + slack).all()
    assert np.abs(object_only[~shown]).max(initial=0) <= ROUNDING
    assert (NO_OBJECT in drawn.warnings) == case.empty == (coverage.max() == 0)


@pytest.mark.parametrize("case", DRAWN.values(), ids=str)
def test_every_layer_is_finite_and_thickness_is_a_share(renderer: Renderer, folder: Path, case: Case) -> None:
    layers = renderer.data(case.scene(folder), ("mesh", "front", "second", "thickness", "blurred_thickness", "surface"))
    mesh = layers.pop("mesh")
    assert mesh.watertight == case.closed
    lengths = [np.sqrt((vectors.astype(np.float64) ** 2).sum(axis=-1)) for vectors in (mesh.normals, mesh.positions)]
    np.testing.assert_allclose(lengths[0], 1, atol=1e-6)
    assert lengths[1].max() == pytest.approx(1, abs=1e-6)
    covered = layers["front"] > 0
    for name, values in layers.items():
        assert np.isfinite(values).all(), name
        assert name == "second" or not values[~covered].any(), name  # an approximate layer may reach further
    assert all(layers[name].min() >= 0 and layers[name].max() <= 1 for name in ("thickness", "blurred_thickness"))
    normals = layers["surface"][covered][:, :3].astype(np.float64)
    np.testing.assert_allclose((normals**2).sum(axis=1), 1, atol=1e-5)
