"""A real path-traced target: what is told of the fit, the files, the command. And the parts that need none."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

import fakesss.cli_fit  # noqa: F401  (adds the command)
from fakesss.cli import commands
from fakesss.media import MEDIA
from fakesss.offline import fit_matched
from fakesss.offline.fit_files import toml
from fakesss.offline.fit_leftover import THICKNESSES, bins, leftover
from fakesss.offline.fit_matched import matched
from fakesss.offline.fit_model import matte
from fakesss.offline.fit_report import Named, Report, duration, fit_medium
from fakesss.offline.fit_start import light_behind, starting_scene
from fakesss.offline.fit_times import Times
from fakesss.offline.settings import PathTracing
from fakesss.problem import BadInput
from fakesss.renderer import Renderer, shared_renderer
from fakesss.scene import Scene

pytestmark = pytest.mark.gl

SCENE = Scene(object="figure:4000", size=(48, 48)).replace({"light.shadows": True})
SETTINGS = PathTracing(medium="ketchup", samples=32)
PARAMETERS = {
    "material.thickness_exponent",
    "material.backlight",
    "material.diffuse_weight",
    "material.diffuse_contribution",
    "material.ambient",
    "material.diffuse",
}


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Report]:
    """Traced now, not taken from an earlier run's cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FAKESSS_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield fit_medium(SCENE, SETTINGS, 2, 0, Named("figure", "fakesss fit figure"), quiet=True)


def test_the_fit_comes_nearer_than_the_start_and_is_a_real_picture(report: Report) -> None:
    told = report.document
    assert told["rmse"] < 0.8 * told["start_errors"]["rmse"] and told["flip"] < told["start_errors"]["flip"]
    assert told["model_max_abs"] < 1e-5
    drawn = shared_renderer().render(matte(report.scene)).image
    np.testing.assert_array_equal(drawn, report.pictures["fitted"])
    assert report.scene.material.specular_contribution == SCENE.material.specular_contribution


def test_the_background_does_not_change_what_is_fitted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Skin of 5 mm is so thin that much of the background shines through."""
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path))
    thin = PathTracing(medium="skin1", size_mm=5, samples=16)
    scene = Scene(object="torus:4000", size=(24, 24))
    black, green = (
        fit_medium(scene.replace({"background": colour}), thin, 1, 0, Named("torus", ""), quiet=True)
        for colour in ((0.0, 0.0, 0.0), (0.1, 0.9, 0.2))
    )
    assert green.scene.material == black.scene.material and green.scene.background == (0.1, 0.9, 0.2)
    assert (green.document["rmse"], green.document["flip"]) == (black.document["rmse"], black.document["flip"])


def test_without_flip_nothing_is_traced_in_vain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fakesss.accuracy.errors.find_spec", lambda name: None)
    monkeypatch.setattr("fakesss.offline.fit_report.path_traced", lambda *_: pytest.fail("traced"))
    with pytest.raises(BadInput, match="FLIP: its package is not installed"):
        fit_medium(SCENE, SETTINGS, 1, 0, Named("figure", ""), quiet=True)


def test_every_key_of_the_document_is_documented(report: Report) -> None:
    page = (Path(__file__).parents[2] / "docs" / "accuracy.md").read_text(encoding="utf-8").split("## Fit")[1]
    nested = ("parameters", "starts", "noise", "seconds", "leftover", "matched", "thickness")
    inside = [report.document[name] for name in nested]
    tables = [report.document, *(next(iter(one.values())) if one is inside[0] else one for one in inside[:1])]
    tables += [inside[1][0], *inside[2:], report.document["leftover"]["thickness"][0]]
    keys = {key for table in tables for key in table}
    assert sorted(key for key in keys if f"`{key}`" not in page) == []


def test_noise_is_told_beside_the_error_and_taken_out_of_it(report: Report) -> None:
    told = report.document
    noise = told["noise"]
    assert 0 < noise["rmse"] < told["rmse"] and 0 < noise["flip"] < told["flip"]
    assert noise["misfit_rmse"] ** 2 + noise["rmse"] ** 2 == pytest.approx(told["rmse"] ** 2)


def test_every_parameter_stands_with_start_bounds_and_error(report: Report) -> None:
    told = report.document["parameters"]
    assert told.keys() == PARAMETERS
    for path, entry in told.items():
        start, fitted, low, high = (np.array(entry[key]) for key in ("start", "fitted", "low", "high"))
        assert (low - 1e-12 <= fitted).all() and (fitted <= high + 1e-12).all()
        np.testing.assert_allclose(fitted, report.scene.at(path))
        assert start.shape == fitted.shape
    errors = [entry["standard_error"] for entry in told.values() if not isinstance(entry["standard_error"], list)]
    assert all(error is None or error > 0 for error in errors) and any(errors)


def test_every_start_and_thickness_is_told(report: Report) -> None:
    told = report.document
    assert len(told["starts"]) == 3 * 2
    least = min(one["rmse"] for one in told["starts"])
    assert {one["thickness"]: one["rmse"] for one in told["thickness"]["tried"]}[told["thickness"]["fitted"]] == least
    assert told["starts"][0]["start"]["diffuse"] == pytest.approx(told["parameters"]["material.diffuse"]["start"])


def test_shares_of_the_leftover_add_up(report: Report) -> None:
    for name in ("thickness", "n_dot_l"):
        told = report.document["leftover"][name]
        assert sum(entry["pixels"] for entry in told) == pytest.approx(1)
        assert sum(entry["share"] for entry in told) == pytest.approx(1)


def test_equal_samples_are_found_between_two_rungs(report: Report) -> None:
    told = report.document["matched"]
    seconds = report.document["seconds"]
    assert told["seconds"] == pytest.approx(told["samples"] / SETTINGS.samples * seconds["path_traced"])
    assert told["speed_up"] == pytest.approx(told["samples"] / SETTINGS.samples * report.document["speed_up"])
    assert seconds["shader"] > 0 and report.document["speed_up"] > 0
    flips = [rung["flip"] for rung in told["curve"]]
    assert told["bound"] in ("", "at most", "at least") and flips == sorted(flips, reverse=True)


@pytest.mark.parametrize(
    ("flip", "samples", "bound"),
    [(0.2, 8 * 2**1.5, ""), (0.5, 8, "at most"), (0.01, 64, "at least"), (0.4 / 2 ** (2 / 3), 16, "")],
)
def test_samples_of_equal_flip(monkeypatch: pytest.MonkeyPatch, flip: float, samples: float, bound: str) -> None:
    """FLIP 0.4 at 8 samples, falling as n^-2/3; a second for eight of them, and 0.01 s for the shader."""

    def ladder(*_: object) -> Any:
        return iter(fit_matched.Rung(n, 0.4 * (n / 8) ** (-2 / 3)) for n in (8, 16, 32, 64))

    monkeypatch.setattr(fit_matched, "ladder", ladder)
    told = matched(SCENE, SETTINGS, np.zeros((1, 1, 4)), flip, Times(0.01, 1 / 8, 12.5), True)
    assert (told["samples"], told["bound"]) == (pytest.approx(samples), bound)
    assert (told["seconds"], told["speed_up"]) == pytest.approx((samples / 8, 12.5 * samples))


def test_the_ladder_ends_at_the_targets_samples(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path))
    scene = Scene(object="torus:4000", size=(8, 8))
    target = shared_renderer().render(matte(scene)).image
    for samples, rungs in ((8, [8]), (16, [8, 16]), (20, [8, 16, 20])):
        settings = SETTINGS.model_copy(update={"samples": samples})
        assert [rung.samples for rung in fit_matched.ladder(scene, settings, target, True)] == rungs


def test_bins_know_where_the_error_was_planted(renderer: Renderer) -> None:
    """A picture made too dark where the object is thin: all of the leftover is there, and negative."""
    picture = renderer.render(matte(SCENE)).image
    thin = renderer.data(SCENE, ("blurred_thickness",))["blurred_thickness"] < THICKNESSES[1]
    dark = picture.copy()
    dark[thin, :3] -= np.float32(0.1)
    told = leftover(SCENE, dark, picture, np.zeros_like(picture[..., :3]))["thickness"]
    assert told[0]["share"] == pytest.approx(1) and told[0]["mean_error"] == pytest.approx([-0.1] * 3)
    assert all(entry["share"] == 0 for entry in told[1:])


def test_noise_is_no_leftover() -> None:
    generator, noise = np.random.default_rng(1), 0.1
    difference = noise * generator.standard_normal((40000, 3))
    difference[:20000, 0] += 0.3
    misfit = (difference**2 - noise**2).sum(axis=1)
    told = bins(np.repeat([-0.7, 0.7], 20000), (-1.0, 0.0, 1.0), difference, misfit)
    assert told[0]["share"] == pytest.approx(1, abs=0.02) and told[1]["share"] == pytest.approx(0, abs=0.02)


def test_a_start_follows_the_medium_and_the_size() -> None:
    thick, thin = (starting_scene(SCENE, MEDIA["marble"], size).material for size in (30.0, 15.0))
    assert thick.thickness_exponent == pytest.approx(2 * thin.thickness_exponent) and thick.diffuse == thin.diffuse
    red = starting_scene(SCENE, MEDIA["ketchup"], 30.0).material
    assert red.diffuse[0] > 10 * red.diffuse[1] and red.thickness_exponent > thick.thickness_exponent
    assert starting_scene(SCENE, MEDIA["spectralon"], 30.0).material.diffuse == pytest.approx((1, 1, 1))


def test_light_from_behind_is_counted_and_light_from_the_front_is_not() -> None:
    scene = SCENE.replace({"light.ambient": (0, 0, 0), "light.elevation": -8.0})
    behind = scene.replace({"light.azimuth": 180.0})
    assert light_behind(behind) == pytest.approx(1.0) and light_behind(scene.replace({"light.azimuth": 0.0})) == 0
    assert light_behind(behind.replace({"lights": [{"azimuth": 180.0}]})) > 1.5


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.0213, "0.021 s"), (12.4, "12 s"), (119, "119 s"), (204, "3.4 min"), (7560, "2.1 h")]
)
def test_durations(seconds: float, text: str) -> None:
    assert duration(seconds) == text


def command(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    line = [sys.executable, "-m", "fakesss", "fit", *map(str, arguments)]
    return subprocess.run(line, capture_output=True, text=True, timeout=200)


def test_the_command_writes_scene_numbers_and_pictures(tmp_path: Path) -> None:
    arguments = ("--size", "24x24", "--samples", "16", "--starts", "1", "-o", tmp_path / "fit", "--json")
    run = command("torus:4000", "--to", "medium.Skin1", *arguments)
    assert run.returncode == 0, run.stderr
    document = json.loads(run.stdout)
    names = (
        "fitted.toml",
        "fit.json",
        "parameters.csv",
        "index.html",
        *(f"{name}.png" for name in ("target", "fitted", "start")),
    )
    assert {*names} <= {path.name for path in (tmp_path / "fit").iterdir()}
    assert json.loads((tmp_path / "fit" / "fit.json").read_text()) == document
    assert document["medium"] == "skin1" and document["sentence"].count(".") > 1
    again = Scene.load(tmp_path / "fit" / "fitted.toml")
    assert again.sha256() == document["scene_sha256"]
    rows = (tmp_path / "fit" / "parameters.csv").read_text().splitlines()
    assert rows[0].startswith("parameter,start,fitted") and len(rows) == 1 + len(PARAMETERS) + 2


def test_a_fitted_mesh_file_is_found_from_any_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    about = {"scene": "part.ply", "medium": "marble", "size_mm": 30.0, "sentence": "As near as that."}
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "fitted.toml").write_text(toml(Scene(object="part.ply"), about))
    assert Scene.load(tmp_path / "elsewhere" / "fitted.toml").object == str(tmp_path / "part.ply")


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--to", "medium.marbel"), '--to: "medium.marbel" is no measured medium; did you mean "marble"?'),
        (("--to", "opaque"), "no measured medium"),
        (("--to", "marble", "--samples", "7"), "samples: 7: must be"),
        (("--to", "marble", "--set", "light.kind=spot"), "path-traced pictures have no spots"),
        (("--to", "marble", "--set", "exposure=0"), "exposure is 0"),
        (("--to", "marble", "--set", "light.diffuse=[0,0,0]", "--set", "light.ambient=[0,0,0]"), "no light shines"),
    ],
)
def test_bad_input_is_one_sentence(arguments: tuple[str, ...], sentence: str) -> None:
    failed = CliRunner().invoke(commands, ["fit", "torus:4000", "--size", "8x8", *arguments]).exception
    assert isinstance(failed, BadInput) and sentence in str(failed) and "\n" not in str(failed)
