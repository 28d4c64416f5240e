"""`fakesss render --path-traced`: the picture, what is told of it, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

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
