"""Pictures without a background: laid over it again they are the opaque picture."""

from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from numpy.typing import NDArray
from PIL import Image

from fakesss.colour import decode_srgb, encode_srgb, to_8bit
from fakesss.problem import BadInput
from fakesss.renderer import Renderer, render_file
from fakesss.scene import Scene
from stimuli.study import Study

pytestmark = pytest.mark.gl

SCENE = Scene(object="figure:8000", size=(97, 64), background=(0.2, 0.5, 0.05), exposure=0.6)
ALPHA = SCENE.replace({"alpha": True})


@pytest.fixture
def opaque(renderer: Renderer) -> NDArray[np.float32]:
    return renderer.render(SCENE).image


@pytest.mark.parametrize("changes", [{}, {"supersampling": 1}, {"style": "as published"}], ids=str)
def test_over_its_background_it_is_the_opaque_picture(renderer: Renderer, changes: dict[str, object]) -> None:
    image = renderer.render(ALPHA.replace(changes)).image
    expected = renderer.render(SCENE.replace(changes)).image
    np.testing.assert_array_equal(image[..., 3], expected[..., 3])
    np.testing.assert_array_equal(image[image[..., 3] == 0], 0)
    over = image[..., :3] + (1 - image[..., 3:]) * np.array(SCENE.background)
    np.testing.assert_allclose(over, expected[..., :3], atol=1e-6)


def test_exr_is_multiplied_by_alpha(renderer: Renderer, tmp_path: Path) -> None:
    render_file(ALPHA, tmp_path / "a.exr")
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        np.testing.assert_array_equal(file.channels()["RGBA"].pixels, renderer.render(ALPHA).image)


def test_png_is_not_and_gives_the_opaque_picture_again(opaque: NDArray[np.float32], tmp_path: Path) -> None:
    render_file(ALPHA, tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.mode == "RGBA"
        pixels = np.asarray(picture)
    colour, alpha = pixels[..., :3], pixels[..., 3:] / 255
    partly = (alpha[..., 0] > 0) & (alpha[..., 0] < 1)
    assert partly.sum() > 100
    np.testing.assert_array_equal(pixels[alpha[..., 0] == 0], 0)
    np.testing.assert_array_equal(pixels[..., 3], np.floor(255 * opaque[..., 3] + 0.5))
    over = decode_srgb(colour / 255) * alpha + (1 - alpha) * np.array(SCENE.background)
    difference = np.abs(to_8bit(over).astype(int) - to_8bit(opaque[..., :3]))
    assert difference[(colour < 255).all(axis=2)].max() <= 1
    # blended as code values, as a browser does, it would not be
    blended = colour * alpha + (1 - alpha) * encode_srgb(np.array(SCENE.background)) * 255
    assert np.abs(blended - to_8bit(opaque[..., :3]))[partly].max() > 10


def test_clipping_is_told_by_the_colour_not_by_colour_times_coverage(renderer: Renderer) -> None:
    lit = {"light.ambient": (4.0, 4.0, 4.0), "light.diffuse": (0, 0, 0), "light.specular": (0, 0, 0)}
    small = {"object": "sphere:4000", "size": (2, 2), "camera.distance": 8.0}  # four samples, one in each pixel
    drawn = renderer.render(ALPHA.replace({**lit, **small, "material.backlight": 0.0}))
    np.testing.assert_allclose(drawn.image[..., 3], 1 / 9, rtol=1e-6)
    assert drawn.image.max() < 1
    assert any("clip" in warning for warning in drawn.warnings)


def test_the_contact_sheet_keeps_its_own_background(tmp_path: Path) -> None:
    for name, scene in (("a", ALPHA), ("b", SCENE)):
        render_file(scene, tmp_path / f"{name}.png", views=True)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


FACTOR = '[[factor]]\nname = "x"\npath = "{}"\nlevels = {}\n'


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[scene]\nalpha = true\n" + FACTOR.format("exposure", "[1.0]"), r"study.toml: scene.alpha: a browser would"),
        (FACTOR.format("alpha", "[false, true]"), r'study.toml: factor "x": level true: a browser would'),
    ],
)
def test_a_study_refuses_it(tmp_path: Path, text: str, sentence: str) -> None:
    (tmp_path / "study.toml").write_text(f'title = "t"\n{text}')
    with pytest.raises(BadInput, match=sentence):
        Study.load(tmp_path)
