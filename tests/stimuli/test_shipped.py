"""The path-traced pictures that come with the program: taken where they fit, and what the code would make again."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from fakesss.colour import decode_srgb
from fakesss.offline.path_tracing import PathTraced, path_traced
from fakesss.offline.settings import NEAR
from fakesss.picture_reading import read_picture
from fakesss.problem import BadInput
from fakesss.shapes import load_object
from stimuli import offline, rebuild_offline, shipped
from stimuli.design import Stimulus
from stimuli.offline import asked_for
from stimuli.picture import build_key, draw, tracing_files
from stimuli.rebuild_offline import asked_by
from stimuli.shipped import shelf

PICTURES = asked_by("thesis")
AGAIN = [each if n in (0, 3) else pytest.param(each, marks=pytest.mark.long) for n, each in enumerate(PICTURES)]
SIDE = 64  # pixels of a picture made again, each the mean of 8 x 8 of the shipped one
TILE = 8  # of them are compared at once
BIAS = 0.015  # relative: of denoising, 8 bits and a shipped picture's own noise, over a tile
BOUND = 4.5  # standard deviations: of 150 tiles in 3 channels one in 300 pictures would be beyond by chance


@pytest.fixture(autouse=True)
def a_cache_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Light that an earlier run kept would hide what the code does now."""
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "cache"))


def ids(stimulus: Any) -> str:
    return str(stimulus.label.removesuffix(", denoised"))


def nobody(*args: Any, **kwargs: Any) -> Any:
    raise AssertionError("nothing is to be traced")


@pytest.mark.parametrize("stimulus", PICTURES, ids=ids)
def test_the_template_s_pictures_are_there_and_nothing_is_traced(
    stimulus: Stimulus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(offline, "path_traced", nobody)
    monkeypatch.setattr(offline, "planned", nobody)
    offline.look_ahead([stimulus], tmp_path)
    drawn = draw(stimulus, size=(512, 512), folder=tmp_path)()
    assert (drawn.width, drawn.height) == (512, 512) and len(drawn.png) < 400_000
    assert drawn.origin is not None
    medium, size_mm = (drawn.origin[name] for name in ("medium", "size_mm"))
    assert stimulus.path_tracing is not None
    assert (medium, size_mm) == (stimulus.path_tracing.medium, stimulus.path_tracing.size_mm)
    assert drawn.origin["noise"] <= NEAR * (stimulus.path_tracing.noise or 1)
    assert drawn.origin.keys() >= {"mitsuba", "samples", "seed", "seconds", "cores", "processor", "shipped"}
    assert bool(drawn.origin["denoised"]) == ("denoised" in stimulus.label)


def test_every_shipped_picture_is_one_of_a_template_s() -> None:
    assert sorted(str(each.path) for each in shelf()) == sorted(
        str(found.path) for each in PICTURES if (found := shipped.shipped(*asked_for(each)))
    )


@pytest.mark.parametrize(
    ("path", "value", "fits"),
    [
        ("light.azimuth", 10, False),
        ("lights", [{"azimuth": 90.0}], False),
        ("camera.azimuth", 1, False),
        ("exposure", 1.0, False),
        ("background", (0, 0, 0), False),
        ("size", (511, 512), False),
        ("object", "head", False),
        ("material.specular", 0.5, False),  # of the highlights
        ("material.backlight", 0.5, True),  # of the shader alone
        ("blur.enabled", False, True),
    ],
)
def test_a_shipped_picture_is_of_one_scene(path: str, value: Any, fits: bool) -> None:
    scene, settings = asked_for(PICTURES[0])
    assert (shipped.shipped(scene.replace({path: value}), settings) is not None) == fits


@pytest.mark.parametrize("stimulus", PICTURES, ids=ids)
def test_a_shipped_picture_is_of_the_mesh_that_its_object_is_now(stimulus: Stimulus) -> None:
    """It is taken by the object's name: a sculpture that changed needs `python -m stimuli.rebuild_offline`."""
    found = shipped.shipped(*asked_for(stimulus))
    assert found is not None and stimulus.scene is not None
    assert found.record["provenance"]["mesh_sha256"] == load_object(stimulus.scene.object).sha256


@pytest.mark.parametrize("highlights", [True, False])
def test_an_opaque_picture_is_of_one_colour_and_a_medium_s_of_any(highlights: bool, tmp_path: Path) -> None:
    made_by = dict.fromkeys(offline.LIBRARIES, "1")

    def key(medium: str, **fields: Any) -> str:
        scene, settings = asked_for(PICTURES[0])
        change = {"medium": medium, "highlights": highlights, "seed": 9}  # a seed of none that is shipped
        changed = replace(
            PICTURES[0],
            scene=scene.replace({f"material.{name}": value for name, value in fields.items()}),
            path_tracing=settings.model_copy(update=change),
        )
        return build_key(changed, (512, 512), tmp_path, made_by)

    assert key("opaque") != key("opaque", diffuse=(0.1, 0.5, 0.2))
    assert key("marble") == key("marble", diffuse=(0.1, 0.5, 0.2))
    assert key("opaque") == key("opaque", backlight=0.0)
    assert (key("opaque") != key("opaque", specular=0.1)) == highlights


@pytest.mark.parametrize("library", offline.LIBRARIES)
def test_a_picture_that_is_traced_here_depends_on_each_library(library: str, tmp_path: Path) -> None:
    made_by = dict.fromkeys(offline.LIBRARIES, "1")
    _, settings = asked_for(PICTURES[0])
    ours = replace(PICTURES[0], path_tracing=settings.model_copy(update={"seed": 9, "highlights": False}))
    before = build_key(ours, (512, 512), tmp_path, made_by)
    assert before != build_key(ours, (512, 512), tmp_path, {**made_by, library: "2"})
    assert before == build_key(ours, (512, 512), tmp_path, {**made_by, "gl_renderer": "another"})


def test_rays_find_the_outline_of_a_picture_that_is_traced() -> None:
    assert "embreex" in offline.LIBRARIES
    assert {"path_tracing.py", "silhouette.py", "crossings.py"} <= {path.name for path in tracing_files()}


def record(folder: Path, name: str, content: str) -> None:
    (folder / f"{name}.json").write_text(content, encoding="utf-8")
    (folder / f"{name}.png").write_bytes(b"")


def test_making_them_again_removes_only_pictures_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "thesis"
    folder.mkdir()
    record(folder, "no-longer-asked-for", f'{{"command": "{rebuild_offline.COMMAND}"}}')
    for number, content in enumerate(["[]", "no JSON", '{"command": "another"}', "{}"]):
        record(folder, f"strange-{number}", content)
    (folder / "notes.txt").write_text("mine", encoding="utf-8")
    (folder / "lonely.png").write_bytes(b"")
    strangers = {path.name for path in folder.iterdir() if not path.name.startswith("no-longer")}
    monkeypatch.setattr(rebuild_offline, "SHELF", tmp_path)
    made = {"command": rebuild_offline.COMMAND, "provenance": {"samples": 8, "noise": 0.5, "seconds": 1}}
    monkeypatch.setattr(rebuild_offline, "rebuild", lambda stimulus: (b"picture", made))
    rebuild_offline.main("thesis")
    ours = {rebuild_offline.file_name(each.label) for each in PICTURES}
    assert len(ours) == 6
    assert {path.name for path in folder.iterdir()} == strangers | {
        f"{name}.{kind}" for name in ours for kind in ("png", "json")
    }


def test_a_template_that_is_not_there_makes_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rebuild_offline, "SHELF", tmp_path)
    with pytest.raises(BadInput, match='template "theses" is not known; did you mean "thesis"'):
        rebuild_offline.main("theses")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("name", "value"), [("medium", "skin2"), ("size_mm", 26), ("seed", 1), ("denoise", False)])
def test_a_shipped_picture_is_of_one_medium_and_one_rendering(name: str, value: Any) -> None:
    scene, settings = asked_for(PICTURES[0])
    assert shipped.shipped(scene, settings.model_copy(update={name: value})) is None


def test_a_changed_record_makes_the_picture_stale(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made_by = dict.fromkeys(offline.LIBRARIES, "1")
    before = build_key(PICTURES[0], (512, 512), tmp_path, made_by)
    assert before == build_key(PICTURES[0], (512, 512), tmp_path, {**made_by, "gl_renderer": "another"})
    other = shelf()[0]
    other = shipped.Shipped(other.path, {**shipped.shipped(*asked_for(PICTURES[0])).record, "sha256": "0"})  # type: ignore[union-attr]
    monkeypatch.setattr(shipped, "shelf", lambda: (other,))
    assert before != build_key(PICTURES[0], (512, 512), tmp_path, made_by)


def test_a_damaged_picture_is_not_shown(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"half")
    with pytest.raises(BadInput, match=r"a\.png: is not the picture of its record; install fakesss again"):
        shipped.Shipped(tmp_path / "a.png", {"sha256": "0"}).png()


def test_how_long_it_takes_is_told_from_the_shipped_ones() -> None:
    scene, settings = asked_for(PICTURES[0])
    minutes = shipped.expected_minutes(scene, settings)
    smaller = shipped.expected_minutes(scene.replace({"size": (256, 256)}), settings)
    noisier = shipped.expected_minutes(scene, settings.model_copy(update={"noise": 2 * (settings.noise or 1)}))
    assert smaller == pytest.approx(minutes / 4) and noisier == pytest.approx(minutes / 4)
    assert [offline.duration(m) for m in (0.2, 7.4, 130)] == ["a minute", "7 minutes", "2 hours"]


def made_small(stimulus: Stimulus, samples: int, **changes: Any) -> PathTraced:
    """The picture again, small, with few samples and other random numbers; `changes`: fields of scene or settings."""
    scene, settings = asked_for(stimulus)
    of_settings = {name: value for name, value in changes.items() if name in type(settings).model_fields}
    of_scene = {name.replace("__", "."): value for name, value in changes.items() if name not in of_settings}
    few = {"samples": samples, "noise": None, "seed": 1, "denoise": False, "highlights": False, **of_settings}
    small = scene.replace({"size": (SIDE, SIDE), **of_scene})
    return path_traced(small, settings.model_copy(update=few), quiet=True)


def furthest(stimulus: Stimulus, again: PathTraced) -> float:
    """By how many standard deviations the mean of a tile differs from the shipped picture's, at most.

    Pixels with highlights, at edges, or as light as the display's white are left out.
    """
    found = shipped.shipped(*asked_for(stimulus))
    assert found is not None
    light = decode_srgb(read_picture(found.path)[0] / 255)
    inside = (again.image[..., 3] == 1) & (means(light.max(axis=2), 8) < 0.9) & ~glossy(stimulus)
    worst = 0.0
    for channel in range(3):
        there, here = means(light[..., channel], 8), again.image[..., channel].astype(np.float64)
        count = totals(inside, inside)
        enough = count >= TILE * TILE / 4
        difference = totals(here - there, inside)[enough]
        noise = totals(again.standard_error[..., channel].astype(np.float64) ** 2, inside)[enough]
        allowed = BIAS * totals(there, inside)[enough]
        worst = max(worst, float(np.abs(difference / np.sqrt(noise + allowed**2)).max()))
    return worst


def glossy(stimulus: Stimulus) -> NDArray[np.bool_]:
    """(SIDE, SIDE): pixels to which the shader adds highlights that can be seen."""
    from fakesss.offline.path_tracing import highlights

    scene, _ = asked_for(stimulus)
    return np.asarray(highlights(scene.replace({"size": (SIDE, SIDE)})).max(axis=2) > 1e-3)


def means(values: NDArray[Any], side: int) -> NDArray[np.float64]:
    """Of squares of side x side pixels."""
    height, width = (length // side for length in values.shape)
    return np.asarray(values.reshape(height, side, width, side).mean(axis=(1, 3)), np.float64)


def totals(values: NDArray[Any], inside: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Sums over the pixels inside, tile by tile."""
    return TILE * TILE * means(np.where(inside, values, 0), TILE)


@pytest.mark.gl
@pytest.mark.parametrize("stimulus", AGAIN, ids=ids)
def test_a_picture_made_again_is_the_shipped_one_within_the_noise(stimulus: Stimulus) -> None:
    assert furthest(stimulus, made_small(stimulus, 32)) < BOUND


OTHERS: list[dict[str, Any]] = [
    {"medium": "skin2"},
    {"light__azimuth": 150.0},
    {"size_mm": 35.0},
    {"light__elevation": 40.0},
    {"exposure": 1.5},
    {"camera__azimuth": 10.0},
]


@pytest.mark.gl
@pytest.mark.parametrize(
    "changes",
    [each if n < 2 else pytest.param(each, marks=pytest.mark.long) for n, each in enumerate(OTHERS)],
    ids=lambda changes: next(iter(changes)),
)
def test_another_medium_light_or_camera_is_noticed(changes: dict[str, Any]) -> None:
    assert furthest(PICTURES[3], made_small(PICTURES[3], 32, **changes)) > BOUND
