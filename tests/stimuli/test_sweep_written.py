"""A study written from a scene and its factors: read, built and checked as one written by hand."""

from pathlib import Path
from typing import Any

import pytest

from fakesss.cli_study import build_study
from fakesss.problem import BadInput
from fakesss.scene import Scene
from stimuli.design import stimuli_of
from stimuli.manifest import manifest_path
from stimuli.study import Study
from stimuli.sweep import write_sweep

SCENE = Scene(object="sphere:1000", size=(64, 48)).replace({"material.backlight": 0.8, "lights": [{"azimuth": 10.0}]})
EXPONENT = {"name": "thickness exponent", "path": "material.thickness_exponent", "levels": [12, 25.5]}
LIGHT = {"name": "further light", "path": "lights.0.azimuth", "levels": [0, 90, 180]}
KERNEL = {"name": "kernel", "path": "blur.kernel", "levels": ["3x3", "9x9"]}
TETRAHEDRON = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def changed(factor: dict[str, Any], **fields: Any) -> list[dict[str, Any]]:
    return [factor | fields]


def test_what_is_written_is_the_scene_with_every_combination_of_levels(tmp_path: Path) -> None:
    path = write_sweep(SCENE, "Exponent by light", tmp_path / "new", [EXPONENT, LIGHT])
    study = Study.load(path.parent)
    assert (study.title, study.scene, study.design.kind) == ("Exponent by light", SCENE, "full-factorial")
    shown = stimuli_of(study)
    assert [stimulus.id for stimulus in shown] == [f"img0{number}" for number in range(1, 7)]
    assert [dict(stimulus.factors) for stimulus in shown] == [
        {"thickness exponent": exponent, "further light": azimuth}
        for exponent in (12, 25.5)
        for azimuth in (0, 90, 180)
    ]
    assert [question["name"] for question in study.question] == ["translucent", "realistic", "varnished"]
    text = path.read_text(encoding="utf-8")
    assert "6 pictures" in text and "# backlight contribution [wb], no unit" in text


def test_the_same_arguments_give_the_same_bytes(tmp_path: Path) -> None:
    first, second = (write_sweep(SCENE, "a", tmp_path / name, [KERNEL, LIGHT]).read_bytes() for name in "ab")
    assert first == second


@pytest.mark.gl
def test_the_study_builds_with_every_table_checked(tmp_path: Path) -> None:
    write_sweep(SCENE, "Words", tmp_path, [KERNEL, {"name": "blur", "path": "blur.enabled", "levels": [True, False]}])
    manifest = build_study(tmp_path)
    assert len(manifest["stimuli"]) == 4 == len(list(manifest_path(tmp_path).parent.glob("img*.png")))
    assert [entry["factors"] for entry in manifest["stimuli"]][1] == {"kernel": "3x3", "blur": False}


def test_more_pictures_than_anybody_draws_are_refused_before_they_are_made_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Four factors of a hundred levels took all memory, and could not be stopped."""
    monkeypatch.setattr("stimuli.sweep.stimuli_of", lambda study: pytest.fail("they were made up"))
    paths = ("material.thickness_exponent", "camera.azimuth", "light.azimuth", "light.elevation")
    factors = [{"name": path, "path": path, "levels": list(range(1, 101))} for path in paths]
    with pytest.raises(BadInput, match=r"100000000 pictures: must be <= 10000; vary less"):
        write_sweep(SCENE, "a", tmp_path / "new", factors)
    assert not (tmp_path / "new").exists()


def test_a_mesh_is_copied_beside_the_study_under_its_own_name(tmp_path: Path) -> None:
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "hare: 1.obj").write_bytes(TETRAHEDRON)
    meshes = [str(tmp_path / folder / "hare: 1.obj") for folder in ("one", "two")]
    factor = {"name": "object", "path": "object", "levels": [meshes[1], "sphere:1000"]}
    folder = tmp_path / "study"
    write_sweep(Scene(object=meshes[0]), "Hares", folder, [factor])
    study = Study.load(folder)
    assert study.scene.object == "hare--1.obj" and study.factor[0].levels == ("hare--1-2.obj", "sphere:1000")
    assert (folder / "hare--1.obj").read_bytes() == TETRAHEDRON == (folder / "hare--1-2.obj").read_bytes()
    with pytest.raises(BadInput, match="exists already"):
        write_sweep(Scene(object=meshes[0]), "Hares", folder, [factor])


def test_a_mesh_that_is_gone_is_said_before_anything_is_written(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"gone\.ply: cannot be read"):
        write_sweep(Scene(object=str(tmp_path / "gone.ply")), "a", tmp_path / "study", [EXPONENT])
    assert not (tmp_path / "study").exists()


def test_nothing_is_written_over(tmp_path: Path) -> None:
    mesh = tmp_path / "hare.obj"
    mesh.write_bytes(TETRAHEDRON)
    folder = tmp_path / "study"
    folder.mkdir()
    (folder / "hare.obj").write_text("another")
    with pytest.raises(BadInput, match=r"hare\.obj: exists already; choose another name"):
        write_sweep(Scene(object=str(mesh)), "a", folder, [EXPONENT])
    assert (folder / "hare.obj").read_text() == "another" and not (folder / "study.toml").exists()
    (folder / "study.toml").write_text("mine")
    with pytest.raises(BadInput, match=r"study\.toml: exists already; choose another folder"):
        write_sweep(SCENE, "a", folder, [EXPONENT])
    assert (folder / "study.toml").read_text() == "mine"


@pytest.mark.parametrize(
    ("factors", "sentence"),
    [
        (changed(EXPONENT, levels=[]), "levels []: must be a list of at least one"),
        (changed(EXPONENT, levels=[12, -1]), 'factor "thickness exponent": level -1: must be >= 0'),
        (changed(EXPONENT, levels=[12, 12.0]), "level 12.0 stands twice; remove one"),
        (changed(EXPONENT, levels=[12, None]), "level None: must be a finite number"),
        (changed(EXPONENT, levels=[float("nan")]), "level nan: must be a finite number"),
        (changed(EXPONENT, path="material.exponent"), 'path "material.exponent" is no scene field'),
        (changed(LIGHT, path="lights.1.azimuth"), "counts from lights.0, and the scene has 1 of them"),
        (changed(EXPONENT, path="size"), "all pictures of a study have one size"),
        (changed(EXPONENT, name=""), "factor name '': must be words on one line"),
        (changed(EXPONENT, name="a\nb"), r"factor name 'a\nb': must be words on one line"),
        (changed(EXPONENT, name="=1+1"), "would be a formula in a spreadsheet"),
        ([EXPONENT, EXPONENT | {"name": "again"}], 'factor path "material.thickness_exponent" is used twice'),
    ],
)
def test_what_is_wrong_with_a_factor_is_one_sentence(
    tmp_path: Path, factors: list[dict[str, Any]], sentence: str
) -> None:
    with pytest.raises(BadInput) as said:
        write_sweep(SCENE, "a", tmp_path / "study", factors)
    assert sentence in str(said.value) and "\n" not in str(said.value)
    assert not (tmp_path / "study").exists()


@pytest.mark.parametrize("title", ["", " ", "a\nb", "a\x07", "\ud800"])
def test_a_title_is_words_on_one_line(tmp_path: Path, title: str) -> None:
    with pytest.raises(BadInput, match=r"title .*: must be words on one line"):
        write_sweep(SCENE, title, tmp_path, [EXPONENT])


@pytest.mark.parametrize("title", ['"quoted" \\ # $scene', "Übergang – 半透明"])
def test_any_words_do(tmp_path: Path, title: str) -> None:
    assert Study.load(write_sweep(SCENE, title, tmp_path, [EXPONENT]).parent).title == title


def test_a_picture_without_background_is_no_stimulus(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="alpha = false"):
        write_sweep(SCENE.replace({"alpha": True}), "a", tmp_path, [EXPONENT])


def test_a_quality_of_which_a_factor_sets_a_knob(tmp_path: Path) -> None:
    scene = SCENE.replace({"quality": "survey"})
    study = Study.load(write_sweep(scene, "a", tmp_path, [KERNEL]).parent)
    assert study.scene == scene
    assert [stimulus.scene for stimulus in stimuli_of(study)] == [
        scene.replace({"blur.kernel": kernel}) for kernel in KERNEL["levels"]
    ]
