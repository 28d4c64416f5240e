"""`fakesss render --path-traced`: the picture, what is told of it, and what is refused."""

import json
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from click.testing import CliRunner
from PIL import Image

import fakesss.cli_picture  # noqa: F401  (adds `render`)
from fakesss.cli import commands
from fakesss.image_io import read_picture
from fakesss.problem import BadInput

pytestmark = pytest.mark.gl


def render(*options: str | Path) -> dict:
    arguments = ["render", "sphere:4000", "--size", "24x16", *map(str, options), "--json"]
    result = CliRunner().invoke(commands, arguments, catch_exceptions=False)
    assert result.exit_code == 0
    return json.loads(result.stdout)


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "cache"))


def test_the_picture_and_its_provenance(tmp_path: Path) -> None:
    options = ("--path-traced", "medium.skin1", "--samples", "32", "--size-mm", "10")
    told = render(*options, "-o", tmp_path / "a.png")
    assert (told["width"], told["height"], told["samples"], told["cached"]) == (24, 16, 32, False)
    assert 0 < told["noise"] < 1 and told["provenance"]["medium"] == "skin1"
    assert told["provenance"]["size_mm"] == 10 and told["provenance"]["denoised"] is False
    pixels, _ = read_picture(tmp_path / "a.png")
    assert pixels[8, 12].min() > pixels[0, 0].max()  # the sphere is brighter than what is behind it
    again = render(*options, "-o", tmp_path / "b.png")
    assert again["cached"] and (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_highlights_are_the_shaders() -> None:
    from fakesss.lighting_terms import alone
    from fakesss.offline.path_tracing import PathTracing, path_traced
    from fakesss.renderer import render as drawn
    from fakesss.scene import Scene

    scene = Scene(object="sphere:4000", size=(24, 24), background=(0.2, 0.0, 0.0))
    glossy, matt = (
        path_traced(scene, PathTracing(medium="skin1", samples=8, highlights=on), quiet=True).image
        for on in (True, False)
    )
    specular = drawn(alone(scene, "specular").replace({"background": (0.0, 0.0, 0.0)}))
    assert specular[..., :3].max() > 0.1
    np.testing.assert_allclose((glossy - matt)[..., :3], specular[..., :3], atol=1e-6)
    outside = matt[..., 3] == 0
    assert (glossy[outside][:, :3] == np.float32(scene.background)).all()


def test_a_file_says_how_it_was_made(tmp_path: Path) -> None:
    for suffix in (".png", ".exr"):
        told = render("--path-traced", "skin1", "--samples", "8", "--seed", "3", "-o", tmp_path / f"a{suffix}")
        assert told["provenance"]["seed"] == 3
    with Image.open(tmp_path / "a.png") as picture:
        words = picture.text["Comment"]
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        assert file.header()["comments"] == words
    assert words.startswith("Path-traced, not the shader's. {") and '"medium": "skin1"' in words


def test_a_denoised_file_is_marked(tmp_path: Path) -> None:
    pytest.importorskip("pyoidn")
    arguments = ["render", "sphere:4000", "--size", "24x16", "--path-traced", "skin1", "--samples", "8", "--denoise"]
    result = CliRunner().invoke(commands, [*arguments, "-o", str(tmp_path / "a.png")], catch_exceptions=False)
    assert ", denoised, " in result.stdout
    with Image.open(tmp_path / "a.png") as picture:
        assert "Denoised by Open Image Denoise" in picture.text["Comment"]


def test_gloss_can_be_left_out(tmp_path: Path) -> None:
    told = render("--path-traced", "skin1", "--samples", "8", "--no-highlights", "-o", tmp_path / "a.png")
    assert told["provenance"]["highlights"] is False


def test_a_noise_that_nobody_knows_is_told_as_such(tmp_path: Path) -> None:
    dark = ("--set", "light.diffuse=[0,0,0]", "--set", "light.ambient=[0,0,0]", "--path-traced", "skin1")
    told = render(*dark, "--samples", "16", "--noise", "0.1", "-o", tmp_path / "a.png")
    assert told["noise"] is None and "hardly any path met light" in " ".join(told["warnings"])


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--samples", "64"], "--samples: belongs to path-traced pictures; add --path-traced MEDIUM"),
        (["--path-traced", "marble", "--views"], "--views: a path-traced picture has no intermediates"),
        (["--path-traced", "marbel"], 'did you mean "marble"'),
        (["--path-traced", "marble", "--noise", "0"], "noise: 0.0: must be > 0"),
    ],
)
def test_what_cannot_be_is_one_sentence(options: list[str], sentence: str) -> None:
    with pytest.raises(BadInput) as error:
        render(*options)
    assert sentence in str(error.value)
