"""Rounds add up, their spread is the noise, and what was interrupted goes on to the same bytes."""

import sys
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from path_traced import SCENE, equal, traced, with_clear_medium

from fakesss.offline import path_tracing, tally
from fakesss.offline.path_tracing import PathTracing, path_traced
from fakesss.offline.settings import ROUND
from fakesss.offline.tally import Tally
from fakesss.problem import BadInput
from fakesss.scene import Scene


class FakeTracer:
    """Radiances by lot instead of by Mitsuba; stops, as Ctrl-C would, at the round of that number."""

    traced: ClassVar[list[int]] = []
    stop_at: ClassVar[int | None] = None

    def __init__(self, scene: Scene, *rest: object) -> None:
        self.shape = (scene.size[1], scene.size[0], 3)

    def __call__(self, number: int) -> NDArray[np.float64]:
        if number == FakeTracer.stop_at:
            raise KeyboardInterrupt
        FakeTracer.traced.append(number)
        return np.random.default_rng(number).random(self.shape)


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "cache"))
    with_clear_medium(monkeypatch)


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> type[FakeTracer]:
    monkeypatch.setattr(path_tracing, "Tracer", FakeTracer)
    FakeTracer.traced, FakeTracer.stop_at = [], None
    return FakeTracer


def test_the_standard_error_is_that_of_the_mean_of_rounds() -> None:
    rounds = np.random.default_rng(1).random((7, 4, 5, 3))
    added, covered = Tally.empty((5, 4)), np.ones((4, 5), bool)
    for radiance in rounds:
        added = added.added(radiance, covered, 0.5)
    expected = rounds.std(axis=0, ddof=1) / np.sqrt(7)
    np.testing.assert_allclose(added.mean, rounds.mean(axis=0))
    np.testing.assert_allclose(added.standard_error, expected)
    alone = (added.mean**2).mean() - (expected**2).mean()  # the grain's own power is not the radiance's
    assert added.noise == pytest.approx(np.sqrt((expected**2).mean() / alone))
    assert added.ratios[0] == np.inf and added.seconds == 3.5


def test_what_is_finished_is_not_traced_again(fake: type[FakeTracer]) -> None:
    first, second = traced(32), traced(32)
    assert fake.traced == list(range(32 // ROUND))
    assert (first.cached, second.cached) == (False, True) and equal(first, second)
    assert second.seconds == first.seconds == second.provenance["seconds"]


def test_more_samples_go_on_from_what_is_there(fake: type[FakeTracer]) -> None:
    traced(16)
    more = traced(32)
    assert fake.traced == list(range(8)) and not more.cached and more.samples == 32


def test_exposure_and_background_trace_nothing_again(fake: type[FakeTracer]) -> None:
    bright = traced(16)
    scene = SCENE.replace({"exposure": 0.5, "background": (1, 0, 0)})
    dark = path_traced(scene, PathTracing(medium="clear", size_mm=2.0, samples=16, highlights=False), quiet=True)
    assert dark.cached
    np.testing.assert_allclose(dark.standard_error, bright.standard_error / 2, rtol=1e-6)


@pytest.mark.parametrize("changed", [{"seed": 1}, {"size_mm": 3.0}, {"medium": "marble"}])
def test_what_changes_the_radiance_is_traced_anew(fake: type[FakeTracer], changed: dict) -> None:
    traced(16)
    assert not traced(16, **changed).cached


def test_fewer_samples_than_kept_are_the_bytes_of_fewer(fake: type[FakeTracer], monkeypatch, tmp_path: Path) -> None:
    traced(64)
    after = traced(16)
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "other"))
    assert equal(after, traced(16))


def test_interrupted_it_keeps_the_last_round_and_ends_the_same(fake: type[FakeTracer], monkeypatch, tmp_path) -> None:
    fake.stop_at = 5
    with pytest.raises(KeyboardInterrupt):
        traced(40)
    fake.stop_at = None
    resumed = traced(40)
    assert fake.traced == list(range(10))  # none twice
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "other"))
    assert equal(resumed, traced(40))


def test_a_noise_target_stops_at_the_same_round_however_much_is_kept(
    fake: type[FakeTracer], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    fresh = traced(256, noise=0.12)
    assert fresh.noise <= 0.12 and 16 <= fresh.samples < 256
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "other"))
    traced(256)
    assert equal(traced(256, noise=0.12), fresh)


def test_a_damaged_tally_is_made_again(fake: type[FakeTracer], tmp_path: Path) -> None:
    whole = traced(16)
    (kept,) = (tmp_path / "cache" / "path-traced").glob("*/*.npz")
    kept.write_bytes(kept.read_bytes()[:1000])
    again = traced(16)
    assert equal(whole, again) and not again.cached


def test_without_mitsuba_the_mend_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mitsuba", None)
    with pytest.raises(BadInput, match=r"pip install 'fakesss\[offline\]'"):
        traced(16)


def test_without_opengl_nothing_is_traced_in_vain(fake: type[FakeTracer], monkeypatch: pytest.MonkeyPatch) -> None:
    def no_opengl(scene: Scene) -> None:
        raise BadInput("OpenGL: none")

    monkeypatch.setattr(path_tracing, "highlights", no_opengl)
    with pytest.raises(BadInput, match="OpenGL"):
        traced(16, highlights=True)
    assert fake.traced == []


def test_parts_that_overlap_are_warned_of(fake: type[FakeTracer], tmp_path: Path) -> None:
    balls = [trimesh.creation.icosphere(2), trimesh.creation.icosphere(2).apply_translation([0.7, 0.1, 0.0])]
    trimesh.util.concatenate(balls).export(tmp_path / "two.ply")
    scene = SCENE.replace({"object": str(tmp_path / "two.ply")})
    settings = PathTracing(medium="marble", samples=8, highlights=False)
    assert path_traced(scene, settings, quiet=True).warnings[0].startswith("Parts of the object overlap")
    assert not path_traced(scene, settings.model_copy(update={"medium": "opaque"}), quiet=True).warnings


def test_without_the_denoiser_the_mend_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fakesss.offline.denoising.find_spec", lambda name: None)
    with pytest.raises(BadInput, match=r"pip install 'fakesss\[denoise\]'"):
        traced(16, denoise=True)


def test_a_quick_preview_leaves_the_interrupted_long_job_alone(fake: type[FakeTracer]) -> None:
    fake.stop_at = 9
    with pytest.raises(KeyboardInterrupt):
        traced(80)
    fake.stop_at = 5
    with pytest.raises(KeyboardInterrupt):
        traced(32)
    fake.stop_at, fake.traced = None, []
    assert traced(16).samples == 16 and fake.traced == list(range(4))
    fake.traced = []
    traced(80)
    assert fake.traced == list(range(9, 20))


def test_before_the_first_round_nothing_is_kept(fake: type[FakeTracer], tmp_path: Path) -> None:
    fake.stop_at = 0
    with pytest.raises(KeyboardInterrupt):
        traced(16)
    assert not list(tmp_path.glob("cache/path-traced/*/*.npz"))


def test_interrupted_while_adding_a_round_it_keeps_the_rounds_before(
    fake: type[FakeTracer], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    asked, whole = [], tally.ratio

    def ratio(*arrays: NDArray[np.float64]) -> float:
        asked.append(arrays)
        if len(asked) == 4:
            raise KeyboardInterrupt
        return whole(*arrays)

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(tally, "ratio", ratio)
        traced(40)
    resumed = traced(40)
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "other"))
    assert equal(resumed, traced(40))


class Dark(FakeTracer):
    """No path meets light."""

    def __call__(self, number: int) -> NDArray[np.float64]:
        return 0 * super().__call__(number)


class Firefly(FakeTracer):
    """One path in all rounds meets light."""

    def __call__(self, number: int) -> NDArray[np.float64]:
        return float(number == 2) * super().__call__(number)


@pytest.mark.parametrize("tracer", [Dark, Firefly])
def test_a_picture_of_nothing_but_noise_meets_no_noise_target(
    fake: type[FakeTracer], monkeypatch: pytest.MonkeyPatch, tracer: type[FakeTracer]
) -> None:
    monkeypatch.setattr(path_tracing, "Tracer", tracer)
    picture = traced(64, noise=0.99)
    assert picture.samples == 64 and picture.noise > 1e3 and "hardly any path met light" in picture.warnings[0]


def test_a_noise_that_was_not_reached_is_said(fake: type[FakeTracer]) -> None:
    missed, met = traced(64, noise=0.01), traced(64, noise=0.5)
    assert missed.warnings == (f"The noise after 64 samples is {missed.noise:.2%}, not 1.00%; raise samples.",)
    assert not met.warnings and not traced(64).warnings


def test_samples_left_empty_are_more_where_a_noise_is_asked_for() -> None:
    assert PathTracing(medium="marble").samples == 256
    assert PathTracing(medium="marble", noise=0.05).samples == 4096
    assert PathTracing(medium="marble", noise=0.05, samples=64).samples == 64


def test_the_end_is_foreseen_from_the_noise() -> None:
    settings = PathTracing(medium="marble", noise=0.05)
    assert [settings.foreseen(8, ratio) for ratio in (0.1, 0.04, np.inf, 9.0)] == [128, 32, 4096, 4096]
    assert PathTracing(medium="marble").foreseen(8, 0.1) == 256
