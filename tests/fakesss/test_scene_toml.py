"""A scene's file: read again it is the same scene, and it names no more than it has to."""

import tomllib
from pathlib import Path
from typing import Any, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fakesss.lights import Light
from fakesss.problem import BadInput
from fakesss.scene import Scene, scene_paths
from fakesss.scene_toml import object_from, scene_tables, scene_toml

OTHERS: dict[str, Any] = {
    "object": "knot:4000",
    "size": (96, 64),
    "quality": "survey",
    "camera.distance": 5.5,
    "camera.near": 0.25,
    "camera.far": 1e4,
    "layers.faces": 1000,
    "shadow.map_size": 64,
    "occlusion.samples": 32,
    "lights": ({}, {"kind": "spot", "azimuth": 100.5, "ambient": (0.0, 0.0, 0.0), "shadows": True}),
}
"""What a field may be instead of its default, where that does not follow from the default."""


def field(path: str) -> Any:
    model: Any = Scene
    *parents, leaf = path.split(".")
    for parent in parents:
        model = model.model_fields[parent].annotation
    return model.model_fields[leaf]


def other(path: str) -> Any:
    usual = Scene().at(path)
    if path in OTHERS:
        return OTHERS[path]
    if isinstance(usual, bool):
        return not usual
    choices = get_args(field(path).annotation)
    if isinstance(usual, tuple):
        return tuple(value / 3 for value in reversed(usual))
    return choices[-1] if usual in choices else type(usual)(usual / 3 + 1e-3)


def read_again(text: str) -> Scene:
    return Scene.from_dict(tomllib.loads(text), "scene.toml")


PATHS = list(scene_paths())


@pytest.mark.parametrize("path", PATHS)
def test_a_field_that_differs_is_written_with_its_unit_and_read_again(path: str) -> None:
    scene = Scene().replace({path: other(path)})
    assert scene.at(path) != Scene().at(path)
    text = scene_toml(scene, Path())
    assert read_again(text) == scene
    assert path == "lights" or field(path).description in text


@given(st.sets(st.sampled_from(PATHS)), st.sampled_from([None, "interactive", "survey", "reference"]))
def test_any_scene_is_read_again(paths: set[str], quality: str | None) -> None:
    changes = {path: other(path) for path in paths if path != "quality"} | {"quality": quality}
    try:
        scene = Scene().replace(changes)
    except BadInput:
        return  # fields that contradict each other
    assert read_again(scene_toml(scene, Path())) == scene
    study = tomllib.loads("[scene]\n" if not scene_tables(scene, "scene") else scene_tables(scene, "scene"))
    assert Scene.from_dict(study["scene"], "study.toml") == scene


def test_a_scene_of_defaults_names_its_object_and_size() -> None:
    assert tomllib.loads(scene_toml(Scene(), Path())) == {"object": "figure", "size": [512, 512]}


def test_what_a_quality_fills_is_left_to_it() -> None:
    scene = Scene().replace({"quality": "survey"})
    assert scene != Scene(quality=None).model_copy(update={"quality": "survey"})  # it does fill something
    assert tomllib.loads(scene_toml(scene, Path())).keys() == {"object", "size", "quality"}


def test_a_default_that_a_quality_would_change_is_written() -> None:
    scene = Scene().replace({"quality": "survey", "blur.kernel": "5x5"})
    assert tomllib.loads(scene_toml(scene, Path()))["blur"] == {"enabled": True, "kernel": "5x5"}
    assert read_again(scene_toml(scene, Path())) == scene


def test_a_field_left_empty_beside_a_quality_that_fills_it_is_still_the_same_picture() -> None:
    scene = Scene().replace({"quality": "interactive", "shadow.map_size": None})
    assert scene.shadow.map_size is None
    text = scene_toml(scene, Path())
    assert '# quality "interactive" is written out field by field: it would fill shadow.map_size' in text
    assert read_again(text) == scene.model_copy(update={"quality": None})


def test_every_field_of_a_further_light_is_written() -> None:
    light = Light(**{name: other(f"light.{name}") for name in Light.model_fields})
    scene = Scene(lights=(Light(), light))
    text = scene_toml(scene, Path())
    assert text.count("[[lights]]") == 2
    assert all(info.description in text for info in Light.model_fields.values() if info.description)
    assert read_again(text) == scene


@pytest.mark.parametrize(
    ("mesh", "named"),
    [
        ("bunny.ply", "bunny.ply"),
        ("meshes/a \"fine\" 'hare'.obj", "meshes/a \"fine\" 'hare'.obj"),
        ("meshes/../bunny.ply", "bunny.ply"),
    ],
)
def test_a_mesh_within_the_folder_is_named_from_there(tmp_path: Path, mesh: str, named: str) -> None:
    scene = Scene(object=str(tmp_path / mesh))
    path = tmp_path / "scene.toml"
    path.write_text(scene_toml(scene, tmp_path), encoding="utf-8")
    assert tomllib.loads(path.read_text(encoding="utf-8"))["object"] == named
    assert Path(Scene.load(path).object).resolve() == Path(scene.object).resolve()


@pytest.mark.parametrize("mesh", ["elsewhere/bunny.ply", "study/sphere", "study/knot:1000.ply"])
def test_one_elsewhere_or_named_like_a_built_in_object_by_its_whole_path(tmp_path: Path, mesh: str) -> None:
    whole = str(tmp_path / mesh)
    assert object_from(tmp_path / "study", whole) == whole
    assert Scene(object=whole).relative_to(tmp_path / "study").object == whole


def test_built_in_objects_stay(tmp_path: Path) -> None:
    assert object_from(tmp_path, "knot:60000") == "knot:60000"
