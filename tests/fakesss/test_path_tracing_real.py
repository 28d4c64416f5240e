"""Mitsuba itself, not radiances by lot: killed, it goes on to the same bytes; its noise is honest and falls."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from path_traced import equal, traced, with_clear_medium
from waiting import until

from fakesss.offline.path_tracing import PathTracing, path_traced
from fakesss.offline.settings import ROUND
from fakesss.scene import Scene


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "cache"))
    with_clear_medium(monkeypatch)


def test_the_denoiser_smooths_the_picture_and_marks_it() -> None:
    rough, smooth = traced(16), traced(16, denoise=True)
    inside = rough.image[..., 3] == 1
    errors = [np.abs(picture.image[inside][:, :3] - 1).mean() for picture in (rough, smooth)]
    assert errors[1] < 0.5 * errors[0]
    assert smooth.provenance["denoised"].startswith("Open Image Denoise") and not rough.provenance["denoised"]
    assert smooth.noise == rough.noise


KILLED = """
from fakesss.offline import path_tracing as p
from fakesss.scene import Scene
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs inherit that it is ignored
p.KEEP_EVERY = 0.0
scene = Scene.from_dict({"object": "sphere:4000", "size": [16, 12]}, "test")
p.path_traced(scene, p.PathTracing(medium="skin1", samples=int(sys.argv[1]), highlights=False), quiet=True)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_a_process_that_was_killed_goes_on_to_the_same_bytes(
    how: signal.Signals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = Scene.from_dict({"object": "sphere:4000", "size": (16, 12)}, "test")
    settings = PathTracing(medium="skin1", samples=160, highlights=False)
    killed = subprocess.Popen([sys.executable, "-c", KILLED, str(1 << 20)], stderr=subprocess.DEVNULL, env=os.environ)
    try:
        until(lambda: bool(list(tmp_path.glob("cache/path-traced/*/latest.npz"))), 120)
        killed.send_signal(how)
        assert killed.wait(60) != 0
    finally:
        killed.kill()
    (latest,) = tmp_path.glob("cache/path-traced/*/latest.npz")
    with np.load(latest) as found:
        rounds = len(found["noises"])
    samples = ROUND * max(rounds + 3, 8)
    settings = settings.model_copy(update={"samples": samples})
    resumed = path_traced(scene, settings, quiet=True)
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "other"))
    assert equal(resumed, path_traced(scene, settings, quiet=True))
    assert not list(tmp_path.glob("cache/path-traced/*/*.part"))


COUNTS = [(8, 64), pytest.param((16, 256), marks=pytest.mark.long)]


@pytest.mark.parametrize("counts", COUNTS)
def test_the_noise_is_what_independent_seeds_differ_by(counts: tuple[int, int]) -> None:
    seeds, samples = counts
    pictures = [traced(samples, seed=seed) for seed in range(seeds)]
    spread = np.var([picture.image[..., :3] for picture in pictures], axis=0, ddof=1)
    claimed = np.mean([picture.standard_error**2 for picture in pictures], axis=0)
    assert np.sqrt(spread.sum() / claimed.sum()) == pytest.approx(1, abs=2.5 / np.sqrt(2 * seeds * 60))


@pytest.mark.parametrize("most", [128, pytest.param(512, marks=pytest.mark.long)])
def test_the_error_falls_with_the_square_root_of_the_samples(most: int) -> None:
    """In the furnace the truth is 1 exactly, so the error needs no reference."""
    samples = [n for n in (8, 32, 128, 512) if n <= most]
    errors = []
    for n in samples:
        pictures = [traced(n, seed=seed) for seed in range(100, 104)]
        well_inside = np.s_[3:9, 5:11]
        errors.append(np.sqrt(np.mean([(picture.image[well_inside][..., :3] - 1) ** 2 for picture in pictures])))
    order = np.polyfit(np.log(samples), np.log(errors), 1)[0]
    assert order == pytest.approx(-0.5, abs=0.08)
