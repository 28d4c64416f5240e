"""What SCENE, --set and --size mean on the command line, and the sentence where they mean nothing."""

from pathlib import Path

import pytest

from fakesss.cli_picture import scene_named
from fakesss.problem import BadInput

STUDY = 'title = "x"\n[scene]\nobject = "sphere:4000"\n'


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "study"
    folder.mkdir()
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    (tmp_path / "plain").mkdir()
    (tmp_path / "figure").mkdir()
    (tmp_path / "scene.toml").write_text('object = "torus"\nsize = [8, 9]\n', encoding="utf-8")
    return folder


@pytest.mark.parametrize("size", ["²x2", "2x²", "5", "x5", "5x5x5", "-1x5", "5 x 5", "5x99999999999999"])
def test_a_size_that_is_none(size: str) -> None:
    with pytest.raises(BadInput, match=f'^--size "{size}": write width x height in pixels, for example 512x512$'):
        scene_named("sphere", (), size)


def test_a_size_out_of_range_is_blamed_on_its_option() -> None:
    with pytest.raises(BadInput, match=r'^--size "0x5": size\[1\]: 0: must be >= 1$'):
        scene_named("sphere", ("material.backlight=0",), "0x5")


@pytest.mark.parametrize("name", ["study", "study/study.toml"])
def test_a_study_is_told_from_a_scene(study: Path, name: str) -> None:
    with pytest.raises(BadInput, match=f"^{name}: is a study; build it and name one of its pictures.*study#img01$"):
        scene_named(name, (), None)


def test_a_folder_without_a_study(study: Path) -> None:
    with pytest.raises(BadInput, match=r"^plain: is a folder; name a scene's TOML file"):
        scene_named("plain", (), None)


def test_scenes_are_what_they_were(study: Path) -> None:
    assert scene_named("figure", (), None).object == "figure"  # a folder of that name does not stand in the way
    scene = scene_named("scene.toml", ("material.backlight=0.5", "size=[7, 7]"), "3x4")
    assert (scene.object, scene.material.backlight, scene.size) == ("torus", 0.5, (3, 4))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (("lights=[]", "lights.0.kind=spot"), "counts from lights.0, and the scene has none"),
        (("lights=5", "lights.0.kind=spot"), "lights: 5: must be a list"),
        (("lights.0.kind=foo",), "--set: lights.0.kind: 'foo': must be 'directional', 'point' or 'spot'"),
    ],
)
def test_changes_are_made_one_after_the_other(study: Path, changes: tuple[str, ...], sentence: str) -> None:
    (study.parent / "lit.toml").write_text("[[lights]]\n", encoding="utf-8")
    with pytest.raises(BadInput) as raised:
        scene_named("lit.toml", changes, None)
    assert sentence in str(raised.value)


def test_a_change_builds_on_the_one_before_it(study: Path) -> None:
    added = scene_named("scene.toml", ('lights=[{kind="point"}]', "lights.0.kind=spot"), None)
    assert [light.kind for light in added.lights] == ["spot"]
    last = scene_named("scene.toml", ("lights=[{}]", "lights.0.kind=spot", "lights=[{azimuth=5.0}]"), None)
    assert [(light.kind, light.azimuth) for light in last.lights] == [("directional", 5.0)]
