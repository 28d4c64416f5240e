import json
import re
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from fakesss.lights import MOST_LIGHTS
from fakesss.problem import BadInput
from fakesss.scene import Scene, check_path, scene_paths


def test_a_scene_survives_toml(tmp_path: Path) -> None:
    scene = Scene(object="knot", size=(640, 480)).replace({"material.backlight": 0.8})
    path = tmp_path / "scene.toml"
    path.write_text(tomli_w.dumps(scene.model_dump(exclude_none=True)))
    assert Scene.load(path) == scene
    assert Scene.load(path).sha256() == scene.sha256() != Scene().sha256()


def test_a_mesh_is_found_beside_its_scene(tmp_path: Path) -> None:
    (tmp_path / "bunny.ply").write_text("ply")
    (tmp_path / "scene.toml").write_text('object = "bunny.ply"')
    assert Scene.load(tmp_path / "scene.toml").object == str(tmp_path / "bunny.ply")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[material]\nbacklihgt = 1", 'material.backlihgt: unknown key; did you mean "backlight"?'),
        ("[material]\nthickness_exponent = -3", "material.thickness_exponent: -3: must be >= 0"),
        ("size = [0, 512]", "size[1]: 0: must be >= 1"),
        ("[camera]\nfield_of_view = 200", "camera.field_of_view: 200: must be <= 170"),
        ("[camera]\nnear = 3\nfar = 2", "camera: near 3.0 must be < far 2.0"),
        ("[material]\nbacklight = nan", "material.backlight: nan: must be a finite number"),
        ("[material", "not valid TOML"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, text: str, sentence: str) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(BadInput) as raised:
        Scene.load(path)
    assert str(raised.value).startswith(f"{path}: ") and sentence in str(raised.value)
    assert "\n" not in str(raised.value)


def test_an_unknown_path_gets_its_nearest() -> None:
    with pytest.raises(BadInput, match=r'did you mean "material.backlight"\?'):
        check_path("material.backlite", "study.toml", 0)
    assert check_path("blur.step", "study.toml", 0) == "blur.step"


def test_every_path_can_be_replaced_by_its_own_value() -> None:
    scene = Scene()
    for path in scene_paths():
        value = scene.model_dump()
        for part in path.split("."):
            value = value[part]
        assert scene.replace({path: value}) == scene


def test_a_level_out_of_range_names_the_source() -> None:
    with pytest.raises(BadInput, match=r'^study\.toml: factor "t": material\.thickness_exponent: -1'):
        Scene().replace({"material.thickness_exponent": -1}, 'study.toml: factor "t"')


def test_the_documented_defaults_are_the_defaults() -> None:
    page = (Path(__file__).parents[2] / "docs" / "scene.md").read_text(encoding="utf-8")
    documented = dict(re.findall(r"^\| `([\w.]+)` \| (.*?) \|", page, flags=re.M))
    for path in scene_paths():
        value = Scene().model_dump(mode="json")
        for part in path.split("."):
            value = value[part]
        assert documented[path] == ("" if value is None else json.dumps(value)), path


def test_paths_of_further_lights() -> None:
    scene = Scene().replace({"lights": [{}, {"kind": "spot"}]})
    assert scene.replace({"lights.1.diffuse": (1, 2, 3)}).at("lights.1.diffuse") == (1, 2, 3)
    assert scene.replace({"lights.0.kind": "point"}).lights[1] == scene.lights[1]


@pytest.mark.parametrize(
    ("path", "sentence"),
    [
        ("lights.2.diffuse", 'path "lights.2.diffuse": counts from lights.0, and the scene has 2 of them; add a'),
        ("lights.1.difuse", 'path "lights.1.difuse" is no scene field; did you mean "lights.1.diffuse"?'),
        ("lights.-1.diffuse", 'did you mean "lights.'),
        ("light.0.diffuse", 'did you mean "lights.0.diffuse"?'),
        ("lights.0", 'path "lights.0" is no scene field'),
    ],
)
def test_wrong_paths_name_the_nearest(path: str, sentence: str) -> None:
    with pytest.raises(BadInput) as raised:
        check_path(path, "study.toml", 2)
    assert str(raised.value).startswith("study.toml: ") and sentence in str(raised.value)


def test_no_further_light_at_all_is_said() -> None:
    with pytest.raises(BadInput, match=r"counts from lights\.0, and the scene has none; add a \[\[lights\]\] table"):
        Scene().replace({"lights.0.diffuse": (1, 1, 1)})


@pytest.mark.parametrize(
    ("lights", "sentence"),
    [
        ([{}] * MOST_LIGHTS, "lights: .*: must have at most 31 items, not 32$"),
        ([{"attenuation": (0, 0, 0)}], r"lights\.0: attenuation \(0, 0, 0\) divides by zero"),
        ([{}, {"cutoff": 0.0}], r"^scene: lights\.1\.cutoff: 0\.0: must be >= 0\.1"),
        ([{"kind": "area"}], r"lights\.0\.kind: 'area': must be 'directional', 'point' or 'spot'"),
    ],
)
def test_lights_that_cannot_be(lights: list[dict[str, Any]], sentence: str) -> None:
    with pytest.raises(BadInput, match=sentence):
        Scene().replace({"lights": lights})


def test_a_change_may_name_a_light_that_one_before_it_added() -> None:
    changed = Scene().replace({"lights": [{"azimuth": 20.0}], "lights.0.kind": "spot"})
    assert [(light.kind, light.azimuth) for light in changed.lights] == [("spot", 20.0)]


@pytest.mark.parametrize(
    ("lights", "sentence"),
    [
        ([], "counts from lights.0, and the scene has none"),
        (5, "lights: 5: must be a list"),
        ([5], "lights.0: 5: must be a table"),
        (None, "lights: None: must be a list"),
        ([{"kind": "foo"}], "lights.0.kind: 'foo': must be 'directional'"),
    ],
)
def test_a_change_may_not_name_a_light_that_one_before_it_took_away(lights: Any, sentence: str) -> None:
    with pytest.raises(BadInput) as raised:
        Scene().replace({"lights": [{}]}).replace({"lights": lights, "lights.0.kind": "spot"}, "--set")
    assert str(raised.value).startswith("--set: ") and sentence in str(raised.value)


def test_only_all_changes_together_have_to_fit() -> None:
    cut = Scene().replace({"camera.near": 1.0, "camera.far": 2.0})
    moved = cut.replace({"camera.near": 3.0, "lights": [{}], "camera.far": 4.0})
    assert (moved.camera.near, moved.camera.far, len(moved.lights)) == (3.0, 4.0, 1)


@pytest.mark.parametrize("size", [[5], [5, 5, 5], 5])
def test_a_list_of_another_length(size: Any) -> None:
    with pytest.raises(
        BadInput, match=r"^scene: size(\[2\])?: .*(is missing; add it|must have at most 2 items|a list)"
    ):
        Scene().replace({"size": size})
