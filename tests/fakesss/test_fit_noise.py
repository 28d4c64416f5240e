"""Of really traced targets: standard errors are what other seeds differ by, the floor what another seed is off by."""

from pathlib import Path

import numpy as np
import pytest

from fakesss.accuracy.errors import errors
from fakesss.media import MEDIA
from fakesss.offline.fit import Fit, Target, fit
from fakesss.offline.fit_model import matte
from fakesss.offline.fit_noise import FEWEST, again, correlation, floor
from fakesss.offline.fit_start import starting_scene
from fakesss.offline.path_tracing import PathTraced, PathTracing, path_traced
from fakesss.scene import Material, Scene

pytestmark = pytest.mark.gl

SCENE = matte(Scene(object="figure:4000", size=(32, 32)).replace({"light.shadows": True}))
FITTED = ("diffuse.0", "diffuse.1", "backlight", "diffuse_contribution")  # of marble's, what is at no bound
COUNTS = [(6, 0.5), pytest.param((40, 0.2), marks=pytest.mark.long)]


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path))


def settings(seed: int) -> PathTracing:
    return PathTracing(medium="marble", samples=32, seed=seed, highlights=False)


def found(seed: int) -> Fit:
    traced = path_traced(SCENE, settings(seed), quiet=True)
    together = correlation(again(SCENE, settings(seed), FEWEST, True), traced.image)
    assert 0.7 < together[0, 1] < 0.95 and 0.4 < together[0, 2] < 0.8
    start = starting_scene(SCENE, MEDIA["marble"], 30.0)
    return fit(start, Target(traced.image, traced.standard_error, together), starts=1, quiet=True)


def value(material: Material, name: str) -> float:
    field, _, channel = name.partition(".")
    return getattr(material, field)[int(channel)] if channel else getattr(material, field)


@pytest.mark.parametrize("counts", COUNTS)
def test_standard_errors_are_what_other_seeds_differ_by(counts: tuple[int, float]) -> None:
    """With independent channels those of the colours would be 1.7 and 3.2 times what they are."""
    seeds, open_by = counts
    fits = [found(2 * seed) for seed in range(seeds)]
    ratios = []
    for name in FITTED:
        spread = np.std([value(each.scene.material, name) for each in fits], ddof=1)
        ratios.append(spread / np.sqrt(np.mean([each.standard_error[name] ** 2 for each in fits])))
    assert np.exp(np.mean(np.log(ratios))) == pytest.approx(1, abs=open_by)
    assert ratios[1] == pytest.approx(1, abs=1.5 * open_by)


def test_the_noise_floor_is_what_another_seed_is_off_by() -> None:
    """Two pictures differ by twice the variance of one."""
    traced: PathTraced = path_traced(SCENE, settings(0), quiet=True)
    other = again(SCENE, settings(0), 32, True)
    halved = traced.image + (other - traced.image) / np.float32(np.sqrt(2))
    wanted = errors(halved, traced.image)
    told = floor(traced, correlation(other, traced.image), wanted, 0)
    assert told["rmse"] == pytest.approx(wanted.rmse, rel=0.15)
    assert told["flip"] == pytest.approx(wanted.flip, rel=0.1)
    assert told["misfit_rmse"] < 0.6 * told["rmse"]
