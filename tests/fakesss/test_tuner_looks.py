"""Intermediates to look at: the data of `fakesss.views`, sample by sample; words and colours say what it is."""

import numpy as np
import pytest

from fakesss.colour import to_8bit
from fakesss.contact_sheet import EMPTY, Panel, colour_mapped
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.tuner.looks import DRAWINGS, ENDS, LOOKS, NAMED, Look, look
from fakesss.views import KINDS, view

SCENE = Scene(object="torus:4000", size=(72, 56)).replace({"blur.step": 0.02})


@pytest.fixture(scope="module")
def looks() -> dict[str, Look]:
    return {name: look(SCENE, name) for name in LOOKS}


def test_the_picture_comes_first_and_every_view_can_be_looked_at() -> None:
    assert next(iter(LOOKS)) == "picture" and LOOKS.keys() == KINDS.keys()
    assert len(set(LOOKS.values())) == len(LOOKS)  # or a list of titles would not tell them apart
    assert {"relief", "profile"} == DRAWINGS


@pytest.mark.gl
@pytest.mark.parametrize("name", LOOKS)
def test_every_look_has_the_scenes_size_and_says_what_it_is(looks: dict[str, Look], name: str) -> None:
    pixels, note, legend = looks[name]
    assert pixels.shape == (56, 72, 3) and pixels.dtype == np.uint8 and pixels.std() > 5
    assert note.startswith(LOOKS[name])
    for said in (legend["scale"] or {}).get("low"), *(mark["label"] for mark in legend["marks"]):
        assert said is None or said in note


@pytest.mark.gl
def test_the_picture_is_the_one_that_is_rendered(renderer: Renderer) -> None:
    image = renderer.render(SCENE).image
    np.testing.assert_array_equal(look(SCENE, "picture").pixels, to_8bit(image[..., :3]))
    over_nothing = SCENE.replace({"alpha": True})
    np.testing.assert_array_equal(look(over_nothing, "picture").pixels, to_8bit(image[..., :3]))


@pytest.mark.gl
@pytest.mark.parametrize("name", ["front", "thickness", "blurred_thickness", "softening", "blur_width", "occlusion"])
def test_nothing_lies_over_the_data(looks: dict[str, Look], name: str) -> None:
    panel = view(SCENE, name)
    assert isinstance(panel, Panel)
    low, high = panel.range()
    expected = colour_mapped((panel.values - low) / (high - low), panel.colours)
    np.testing.assert_array_equal(looks[name].pixels[panel.covered], expected[panel.covered])
    assert (looks[name].pixels[~panel.covered] == EMPTY).all()


@pytest.mark.gl
def test_a_profile_of_fewer_pixels_has_no_larger_letters() -> None:
    """A moving picture may be drawn smaller, and is shown as large as the one at rest."""
    small, large = (
        look(SCENE.replace({"size": size}), "profile").pixels.astype(float) for size in ((200, 200), (400, 400))
    )
    halved = large.reshape(200, 2, 200, 2, 3).mean(axis=(1, 3))
    assert np.abs(small - halved).mean() < 2


@pytest.mark.gl
def test_marks_are_the_marked_pixels_and_no_others() -> None:
    scene = Scene(object="shell:8000", size=(96, 96)).replace({"camera.azimuth": 25.0})
    panel, shown = view(scene, "hard_edges"), look(scene, "hard_edges")
    assert isinstance(panel, Panel)
    (mark,), (key,) = panel.marks, shown.legend["marks"]
    assert mark.pixels.any()
    np.testing.assert_array_equal((shown.pixels == mark.colour).all(axis=2), mark.pixels)
    assert bytes.fromhex(key["colour"][1:]) == bytes(mark.colour) and key["label"] == mark.label
    assert f"{NAMED[mark.colour]}: {mark.label}" in shown.note


@pytest.mark.gl
def test_the_legend_has_the_colours_of_the_data(looks: dict[str, Look]) -> None:
    """A page draws straight lines between the legend's colours."""
    for name, shown in looks.items():
        if scale := shown.legend["scale"]:
            panel = view(SCENE, name)
            assert isinstance(panel, Panel) and panel.colours in ENDS
            stops = np.array([list(bytes.fromhex(colour[1:])) for colour in scale["colours"]], float)
            shares = np.linspace(0, 1, 200)
            drawn = [np.interp(shares, np.linspace(0, 1, len(stops)), stops[:, channel]) for channel in range(3)]
            exact = colour_mapped(shares, panel.colours).astype(float)
            assert np.abs(np.stack(drawn, axis=1) - exact).max() <= 6, panel.colours
            low, high = panel.range()
            assert float(scale["low"]) == pytest.approx(low, abs=0.006)
            assert float(scale["high"]) == pytest.approx(high, abs=0.006)


@pytest.mark.gl
def test_occlusion_can_be_looked_at_where_the_picture_does_without(looks: dict[str, Look]) -> None:
    without = SCENE.replace({"occlusion.enabled": False})
    np.testing.assert_array_equal(look(without, "occlusion").pixels, looks["occlusion"].pixels)


def test_what_is_no_view_is_refused_in_a_sentence() -> None:
    with pytest.raises(BadInput, match='view "thicknes": there is none; did you mean "thickness"'):
        look(SCENE, "thicknes")
