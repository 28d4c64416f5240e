"""Image cues: closed forms, what must not change them, and what a build writes of them."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from scipy import stats
from test_build import STUDY

from fakesss.renderer import shared_renderer
from fakesss.scene import Scene
from stimuli import picture
from stimuli.build import build, verify
from stimuli.cues import (
    NOTHING_COVERED,
    OTHER_ORIGIN,
    NoCue,
    cues_of_picture,
    cues_of_rendering,
    gradient_energy,
    luminance_skew,
    mean_luminance,
    mean_thickness,
    rms_contrast,
    rounded,
    saturation_intensity_correlation,
)
from stimuli.manifest import manifest_path

BLACK = (0.0, 0.0, 0.0)
ROUNDING = 2e-6  # of six digits, and of float32 where coverage is 1/9


def whole(rgb: Any) -> Any:
    """A rendering (H, W, 4) that the object fills."""
    return np.dstack([rgb, np.ones(np.shape(rgb)[:2])])


def grey(light: Any) -> Any:
    return whole(np.repeat(np.asarray(light, float)[..., None], 3, axis=2))


def values(image: Any, background: Any = BLACK) -> dict[str, float | None]:
    return cues_of_rendering(image, background, 0.25).values


def test_a_checkerboard() -> None:
    """Contrast (b - a) / (b + a); every step is one, so their mean square is 4 times the variance, in both ways."""
    board = np.indices((8, 6)).sum(axis=0) % 2
    found = cues_of_rendering(grey(0.1 + 0.3 * board), BLACK, 0.25)
    assert found.values["mean_luminance"] == pytest.approx(0.25)
    assert found.values["rms_contrast"] == pytest.approx(0.6)
    assert found.values["luminance_skew"] == 0
    assert found.values["gradient_energy"] == pytest.approx(8)
    assert found.values["highlight_share"] == 0
    assert found.values["mean_thickness"] == 0.25
    assert found.values["saturation_intensity_correlation"] is None
    assert found.missing == {
        "saturation_intensity_correlation": "the object is grey, so no saturation goes along with intensity"
    }


@pytest.mark.parametrize(("along", "down"), [(0.01, 0.0), (0.01, 0.02), (0.0, 0.003)])
def test_a_ramp(along: float, down: float) -> None:
    """The variance of 0..n-1 is (n^2 - 1) / 12."""
    height, width = 12, 20
    y, x = np.indices((height, width))
    expected = (along**2 + down**2) / (along**2 * (width**2 - 1) / 12 + down**2 * (height**2 - 1) / 12)
    assert values(grey(0.2 + along * x + down * y))["gradient_energy"] == pytest.approx(expected, rel=ROUNDING)


def test_known_skew() -> None:
    """A share p of ones has skew (1 - 2p) / sqrt(p (1 - p))."""
    light, all_of_it = np.repeat([0.0, 1.0], [80, 20]), np.ones(100)
    assert luminance_skew(light, all_of_it) == pytest.approx(0.6 / 0.4)
    drawn = np.random.default_rng(1).gamma(4.0, size=500)
    assert luminance_skew(drawn, np.ones(500)) == pytest.approx(stats.skew(drawn))
    assert luminance_skew(drawn, np.full(500, 0.3)) == pytest.approx(stats.skew(drawn))


def test_saturation_rising_with_intensity_is_warm_and_falling_is_icy() -> None:
    """R = G = I (1 + S / 2), B = I (1 - S)."""
    intensity = np.array([0.1, 0.2, 0.3, 0.4])
    for saturation, expected in (
        ([0.2, 0.4, 0.6, 0.8], 1.0),
        ([0.8, 0.6, 0.4, 0.2], -1.0),
        ([0.1, 0.5, 0.1, 0.5], None),
    ):
        s = np.array(saturation)
        rgb = np.array([intensity * (1 + s / 2), intensity * (1 + s / 2), intensity * (1 - s)])
        found = saturation_intensity_correlation(rgb, np.ones(4))
        assert found == pytest.approx(np.corrcoef(s, intensity)[0, 1] if expected is None else expected)


def test_black_pixels_have_no_saturation() -> None:
    rgb = np.array([[0.0, 0.2, 0.5], [0.0, 0.1, 0.1], [0.0, 0.1, 0.1]])
    with_black = saturation_intensity_correlation(rgb, np.ones(3))
    assert with_black == pytest.approx(saturation_intensity_correlation(rgb[:, 1:], np.ones(2)))


def test_what_the_display_shows_as_black_has_no_saturation() -> None:
    """A fifth of the object is a red of 1e-7, below the first code value: no eye sees that it is saturated."""
    ramp = np.linspace(0.1, 0.5, 80)
    glow = np.array([ramp, ramp * 0.8, ramp * (0.8 - ramp)])
    unseen = np.zeros((3, 20))
    unseen[0] = 1e-7
    alone = saturation_intensity_correlation(glow, np.ones(80))
    assert alone > 0.9
    assert saturation_intensity_correlation(np.hstack([glow, unseen]), np.ones(100)) == alone
    with pytest.raises(NoCue, match="the object is black"):
        saturation_intensity_correlation(unseen, np.ones(20))


def test_the_first_code_value_of_a_picture_made_elsewhere_is_seen() -> None:
    """Two greys and a red of code value 1: the darkest light that 8 bits can say."""
    pixels = np.array([[[120, 120, 120], [60, 60, 60], [1, 0, 0]]], np.uint8)
    assert cues_of_picture(pixels).values["saturation_intensity_correlation"] is not None


def test_highlights_are_bright_in_every_channel_and_left_out_of_the_rest() -> None:
    glow, dull, spot = [0.9, 0.6, 0.2], [0.3, 0.2, 0.1], [1.4, 1.2, 0.9]
    found = values(whole([[glow, dull, glow, dull, spot]]))
    without = values(whole([[glow, dull, glow, dull]]))
    assert found["highlight_share"] == pytest.approx(0.2)
    assert found["contrast_beside_highlights"] == without["rms_contrast"]
    assert found["rms_contrast"] != found["contrast_beside_highlights"]


def test_light_beyond_the_displays_white_is_white() -> None:
    assert values(grey([[0.2, 1.0]])) == values(grey([[0.2, 7.0]]))


@pytest.mark.parametrize(
    ("image", "reasons"),
    [
        (np.zeros((3, 4, 4)), dict.fromkeys(values(grey([[0.5, 0.2]])), NOTHING_COVERED)),
        (
            grey(np.zeros((3, 4))),
            {
                "rms_contrast": "the object is black, and contrast is relative to its mean luminance",
                "contrast_beside_highlights": "the object is black, and contrast is relative to its mean luminance",
                "luminance_skew": "the object has one luminance, which has no skew",
                "saturation_intensity_correlation": "the object is black, which has no saturation",
                "gradient_energy": "the object has one luminance, which is neither sharp nor blurred",
            },
        ),
        (
            whole(np.full((2, 2, 3), (0.9, 0.8, 0.7))),
            {
                "contrast_beside_highlights": "all of the object is highlight",
                "luminance_skew": "the object has one luminance, which has no skew",
                "saturation_intensity_correlation": "the object has one saturation, so nothing goes along with it",
                "gradient_energy": "the object has one luminance, which is neither sharp nor blurred",
            },
        ),
        (
            whole([[[0.3, 0.1, 0.2], [0.2, 0.3, 0.1]]]),
            {"saturation_intensity_correlation": "the object has one saturation, so nothing goes along with it"},
        ),
        (
            whole([[[0.3, 0.1, 0.2], [0.25, 0.15, 0.2]]]),
            {"saturation_intensity_correlation": "the object has one intensity, so nothing goes along with it"},
        ),
    ],
)
def test_what_a_picture_does_not_have_is_said(image: Any, reasons: dict[str, str]) -> None:
    thickness = mean_thickness(np.zeros((6, 8)), image[..., 3])
    found = cues_of_rendering(image, (0.2, 0.2, 0.2), thickness if thickness is None else 0.25)
    assert found.missing == {name: reasons[name] for name in found.values if name in reasons}
    assert [name for name, value in found.values.items() if value is None] == list(found.missing)


def picture_of(seed: int) -> Any:
    """A coloured object with soft edges over black, (24, 20, 4) in float64."""
    rng = np.random.default_rng(seed)
    coverage = np.clip(rng.uniform(-0.5, 1.5, (24, 20)), 0, 1)
    return np.dstack([rng.uniform(0.05, 0.6, (24, 20, 3)) * coverage[..., None], coverage])


seeds = st.integers(0, 2**32 - 1)
SCALE_FREE = ("rms_contrast", "luminance_skew", "saturation_intensity_correlation", "gradient_energy")


@given(seeds)
def test_what_must_not_change_a_cue(seed: int) -> None:
    image = picture_of(seed)
    found = values(image)
    about = {"rel": ROUNDING, "abs": 1e-8}
    assert values(image[:, ::-1]) == pytest.approx(found, **about)
    assert values(image[::-1]) == pytest.approx(found, **about)
    assert values(np.swapaxes(image, 0, 1)) == pytest.approx(found, **about)
    assert values(np.pad(image, ((3, 0), (1, 7), (0, 0)))) == pytest.approx(found, **about)
    behind = np.array([0.9, 0.1, 0.4])
    over = np.dstack([image[..., :3] + (1 - image[..., 3:]) * behind, image[..., 3]])
    assert values(over, tuple(behind)) == pytest.approx(found, **about)
    assert values(over.astype(np.float32), tuple(behind)) == pytest.approx(found, rel=1e-4, abs=1e-5)


@given(seeds, st.floats(0.01, 1.0))
def test_luminance_has_no_scale_but_in_its_mean(seed: int, factor: float) -> None:
    image = picture_of(seed)
    dimmed = np.dstack([image[..., :3] * factor, image[..., 3]])
    found, dim = values(image), values(dimmed)
    assert [dim[name] for name in SCALE_FREE] == pytest.approx([found[name] for name in SCALE_FREE], rel=1e-5, abs=1e-7)
    assert dim["mean_luminance"] == pytest.approx(factor * (found["mean_luminance"] or 0), rel=1e-5)


@given(seeds, st.floats(-0.04, 0.4))
def test_a_shift_of_luminance_leaves_skew_and_blur_and_divides_contrast(seed: int, shift: float) -> None:
    light = np.random.default_rng(seed).uniform(0.05, 0.6, (9, 7))
    before, after = values(grey(light)), values(grey(light + shift))
    for name in ("luminance_skew", "gradient_energy"):
        assert after[name] == pytest.approx(before[name], rel=1e-5, abs=1e-8)
    spread = rms_contrast(light.ravel(), np.ones(63)) * mean_luminance(light.ravel(), np.ones(63))
    assert after["rms_contrast"] == pytest.approx(spread / (light.mean() + shift), rel=1e-5)


def test_blur_takes_gradient_energy_away() -> None:
    rng = np.random.default_rng(3)
    light = rng.uniform(0.1, 0.5, (40, 40))
    soft = (light + np.roll(light, 1, 0) + np.roll(light, 1, 1) + np.roll(light, 1, (0, 1))) / 4
    assert (values(grey(soft))["gradient_energy"] or 9) < 0.6 * (values(grey(light))["gradient_energy"] or 0)


def test_a_gap_in_the_object_is_no_step() -> None:
    image = np.pad(grey([[0.2, 0.2, 0.2]]), ((0, 0), (0, 4), (0, 0)))
    image[0, 5] = (0.8, 0.8, 0.8, 1.0)
    assert values(image)["gradient_energy"] == 0


def test_one_column_has_steps_one_way_only() -> None:
    light, inside = np.array([0.1, 0.3]), np.ones((2, 1), bool)
    assert gradient_energy(light, np.ones(2), inside) == pytest.approx(4)
    assert gradient_energy(light, np.ones(2), np.eye(2, dtype=bool)) == 0


def test_nothing_has_no_mean() -> None:
    with pytest.raises(NoCue, match=NOTHING_COVERED):
        mean_luminance(np.zeros(0), np.zeros(0))


def test_numbers_are_rounded_to_what_every_processor_gives() -> None:
    assert rounded(0.123456789) == 0.123457 and rounded(1234567.0) == 1234570.0
    assert str(rounded(-3e-17)) == "0.0" and rounded(1e-7 / 3) == 3.3e-8


def test_a_picture_made_elsewhere_has_cues_of_all_of_it_and_no_thickness() -> None:
    board = np.where(np.indices((4, 4)).sum(axis=0) % 2, 188, 0).astype(np.uint8)  # sRGB 188 is linear .503
    found = cues_of_picture(np.repeat(board[..., None], 3, axis=2))
    assert found.values["mean_luminance"] == pytest.approx(0.5029 / 2, abs=1e-4)
    assert found.values["rms_contrast"] == pytest.approx(1)
    assert found.values["highlight_share"] == 0.5
    assert found.values["mean_thickness"] is None and found.missing["mean_thickness"] == OTHER_ORIGIN


def test_every_cue_is_documented() -> None:
    page = (Path(__file__).parents[2] / "docs" / "cues.md").read_text(encoding="utf-8")
    names = cues_of_picture(np.zeros((1, 1, 3), np.uint8)).values
    assert [name for name in (*names, "cues", "cues_missing") if f"`{name}`" not in page] == []


SPHERE = {"object": "sphere", "size": (64, 64), "supersampling": 2, "camera.distance": 200.0, "occlusion.rays": 16}


@pytest.mark.gl
def test_the_mean_thickness_of_a_sphere_is_two_thirds() -> None:
    """From afar: the mean chord of a disc of parallel rays, 4 R / 3, in diameters."""
    found = picture.rendered(Scene().replace({**SPHERE, "camera.field_of_view": 1.0}))[2]
    assert found == pytest.approx(2 / 3, abs=0.01)


@pytest.mark.gl
@pytest.mark.parametrize(
    "change", [{}, {"blur.enabled": False}, {"material.backlight": 0.0}, {"style": "as published"}]
)
def test_the_thickness_beside_changes_no_byte_and_no_pass_of_the_picture(change: dict[str, Any]) -> None:
    scene = Scene().replace({"object": "torus:4000", "size": (48, 40), "occlusion.rays": 16, **change})
    renderer = shared_renderer()
    plain = renderer.render(scene)
    beside, thickness = renderer.render_with(scene, "thickness")
    assert beside.image.tobytes() == plain.image.tobytes()
    assert (beside.passes, beside.warnings) == (plain.passes, plain.warnings)
    samples = 1 if "style" in change else scene.supersampling
    assert thickness.shape == (40 * samples, 48 * samples)
    assert thickness.tobytes() == renderer.data(scene, ("thickness",), samples)["thickness"].tobytes()


@pytest.mark.gl
@pytest.mark.parametrize(
    ("change", "again"),
    [
        ({"material.backlight": 0.3, "light.azimuth": 10.0, "exposure": 0.5, "background": (1.0, 1.0, 1.0)}, False),
        ({"blur.step": 0.01, "occlusion.enabled": False, "lights": ({"azimuth": 9.0},)}, False),
        ({"camera.azimuth": 40.0}, True),
        ({"material.thickness": "total-path"}, True),
        ({"size": (40, 48)}, True),
    ],
)
def test_thickness_is_measured_once_for_what_it_depends_on(change: dict[str, Any], again: bool) -> None:
    scene = Scene().replace({"object": "torus:4000", "size": (48, 40), "occlusion.rays": 16})
    changed = scene.replace(change)
    picture.thicknesses.clear()
    first = picture.rendered(scene)[2]
    second = picture.rendered(changed)[2]
    assert len(picture.thicknesses.values) == 1 + again
    picture.thicknesses.clear()
    assert picture.rendered(changed)[2] == second
    assert again or second == first


@pytest.mark.gl
def test_the_background_is_no_part_of_the_object() -> None:
    scene = Scene().replace({"object": "torus:4000", "size": (48, 40), "occlusion.rays": 16})
    over = [scene.replace({"background": colour}) for colour in (BLACK, (1.0, 0.0, 0.5))]
    dark, bright = (cues_of_rendering(shared_renderer().render(one).image, one.background, None).values for one in over)
    assert {k: v for k, v in bright.items() if v} == pytest.approx({k: v for k, v in dark.items() if v}, rel=1e-4)


def cues_in(folder: Path) -> list[Any]:
    entries = json.loads(manifest_path(folder).read_bytes())["stimuli"]
    return [(entry["cues"], entry["cues_missing"]) for entry in entries]


@pytest.mark.gl
def test_a_build_writes_cues_and_takes_them_over(tmp_path: Path) -> None:
    compare = '[[compare]]\nimage = "other.png"\n'
    (tmp_path / "study.toml").write_text(STUDY + compare, encoding="utf-8")
    Image.new("RGB", (48, 40), (200, 100, 50)).save(tmp_path / "other.png")
    build(tmp_path, quiet=True)
    first = cues_in(tmp_path)
    assert len(first) == 5 and first[0] == first[2]  # img01 and img03 are one picture
    own = first[0][0]
    assert 0 < own["mean_thickness"] < 1 and own["mean_luminance"] > first[1][0]["mean_luminance"] > 0
    assert list(first[4][1]) == [name for name, value in first[4][0].items() if value is None]
    assert build(tmp_path, quiet=True)["stimuli"][0]["cues"] == own and cues_in(tmp_path) == first
    assert verify(tmp_path, quiet=True) == []


@pytest.mark.gl
def test_verify_tells_cues_that_are_not_the_pictures(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    manifest = build(tmp_path, quiet=True)
    manifest["stimuli"][1]["cues"]["rms_contrast"] = 9.0
    del manifest["stimuli"][2]["cues"]  # an earlier version's manifest has none
    manifest_path(tmp_path).write_text(json.dumps(manifest), encoding="utf-8")
    assert verify(tmp_path, quiet=True) == ["img02: its image cues are not the manifest's; run `fakesss build --force`"]


def test_cues_that_are_computed_otherwise_make_pictures_stale() -> None:
    assert "cues.py" in [path.name for path in picture.drawing_files()]
