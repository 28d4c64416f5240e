"""What is taken home from the tuner: scene files and studies, as they were seen, and nothing written over."""

import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

from tuner_server import tuned

from fakesss.cli_study import build_study
from fakesss.output import write_new
from fakesss.renderer import render_file
from fakesss.scene import Scene
from fakesss.tuner.keep import file_name, plain_name, quoted
from stimuli.sweep import write_sweep

BASE = Scene(object="sphere:1000", size=(64, 48))
SETTINGS: dict[str, Any] = {
    "changes": {"material.backlight": 0.8, "light.azimuth": 40, "lights": [{"kind": "spot", "shadows": True}]},
    "effects": {"occlusion": "off", "shadows": "on"},
}
SCENE = BASE.replace(SETTINGS["changes"]).replace(
    {"occlusion.enabled": False, "light.shadows": True, "lights.0.shadows": True}
)
EXPONENT = {"name": "exponent", "path": "material.thickness_exponent", "levels": [12, 25]}
TETRAHEDRON = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("kept")


@pytest.fixture(scope="module")
def client(folder: Path) -> Iterator[httpx.Client]:
    with tuned(BASE, folder, write_study=write_sweep) as url, httpx.Client(base_url=url, timeout=60) as found:
        yield found


def said(response: httpx.Response) -> str:
    """The one sentence of a refusal."""
    assert response.status_code == 422
    sentence: str = response.json()["error"]
    assert "\n" not in sentence
    return sentence


def test_the_scene_on_the_stage_is_a_file_to_download(client: httpx.Client) -> None:
    response = client.post("scene.toml", json={"settings": SETTINGS}).raise_for_status()
    assert response.headers["content-disposition"] == 'attachment; filename="scene.toml"'
    assert Scene.from_dict(tomllib.loads(response.text), "scene.toml") == SCENE


@pytest.mark.gl
def test_the_saved_scene_draws_the_very_bytes_of_the_stage(client: httpx.Client, folder: Path) -> None:
    answer = client.post("save", json={"settings": SETTINGS, "file": "as seen"}).raise_for_status().json()
    path = folder / "as seen.toml"
    assert answer["scene"] == str(path) and Scene.load(path) == SCENE
    assert answer["command"] == f"fakesss render '{path}' -o '{path.with_suffix('.png')}'"
    render_file(Scene.load(path), str(path.with_suffix(".png")))
    seen = client.post("picture", json={"settings": SETTINGS}).raise_for_status().content
    assert path.with_suffix(".png").read_bytes() == seen


def test_nothing_is_written_over(client: httpx.Client, folder: Path) -> None:
    (folder / "mine.toml").write_text("mine")
    assert "exists already; choose another name" in said(client.post("save", json={"file": "mine.toml"}))
    (folder / "mine").mkdir()
    (folder / "mine" / "study.toml").write_text("mine")
    asked = {"title": "a", "folder": "mine", "factors": [EXPONENT]}
    assert "exists already; choose another folder" in said(client.post("study", json=asked))
    assert (folder / "mine.toml").read_text() == "mine" == (folder / "mine" / "study.toml").read_text()


NOT_PLAIN = (
    *("", ".", "..", "../up", "/etc/passwd", "a/b", "a\\b", ".hidden", " a", "a ", "a.", "nul", "Con.toml"),
    *("lpt1.x.toml", "a\nb", "a\0b", "~", "-rf", "c:a", "x" * 101, "影" * 100),
)


@pytest.mark.parametrize("name", NOT_PLAIN)
def test_names_that_lead_elsewhere_or_are_no_files_are_refused(client: httpx.Client, folder: Path, name: str) -> None:
    before = sorted(folder.rglob("*"))
    assert said(client.post("save", json={"file": name})).startswith('file "')
    asked = {"title": "a", "folder": name, "factors": [EXPONENT]}
    assert said(client.post("study", json=asked)).startswith('folder "')
    assert sorted(folder.rglob("*")) == before


@pytest.mark.parametrize(
    "name", ["a", "scene.toml", "Übergang 3", "light-2.final", "console", "x" * 100, "影" * 66, "2011"]
)
def test_plain_names_are_accepted(tmp_path: Path, name: str) -> None:
    assert plain_name(name, "file") == name
    write_new(tmp_path / file_name(name), b"")  # it is written under a longer name first


def test_a_command_names_what_lies_here_from_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert quoted(tmp_path / "a b" / "scene.toml") == "'a b/scene.toml'"
    assert quoted(Path("scene.toml")) == "scene.toml"
    assert quoted(tmp_path.parent / "scene.toml") == str(tmp_path.parent / "scene.toml")


def test_a_scene_is_not_called_as_a_study_is(client: httpx.Client) -> None:
    assert "is the name of a study" in said(client.post("save", json={"file": "study.toml"}))


def test_an_uploaded_mesh_is_put_beside_what_names_it(client: httpx.Client, folder: Path) -> None:
    brought = client.post("object", params={"name": "hare.obj"}, content=TETRAHEDRON).raise_for_status().json()
    settings = {"changes": {"object": brought["object"]}}
    client.post("save", json={"settings": settings, "file": "hare.toml"}).raise_for_status()
    assert Scene.load(folder / "hare.toml").object == str(folder / "hare.obj")
    assert (folder / "hare.obj").read_bytes() == TETRAHEDRON
    asked = {"settings": settings, "title": "Hares", "folder": "hares", "factors": [EXPONENT]}
    client.post("study", json=asked).raise_for_status()
    assert tomllib.loads((folder / "hares" / "study.toml").read_text())["scene"]["object"] == "object.obj"
    assert (folder / "hares" / "object.obj").read_bytes() == TETRAHEDRON

    (folder / "other.obj").write_text("mine")
    assert "other.obj: exists already" in said(client.post("save", json={"settings": settings, "file": "other.toml"}))
    assert not (folder / "other.toml").exists() and (folder / "other.obj").read_text() == "mine"


def test_no_other_file_of_this_computer_is_read(client: httpx.Client, folder: Path, tmp_path: Path) -> None:
    (tmp_path / "secret.obj").write_bytes(TETRAHEDRON)
    settings = {"changes": {"object": str(tmp_path / "secret.obj")}}
    factor = {"name": "object", "path": "object", "levels": ["sphere:1000", str(tmp_path / "secret.obj")]}
    asked = {"title": "a", "folder": "secrets"}
    for response in (
        client.post("scene.toml", json={"settings": settings}),
        client.post("save", json={"settings": settings, "file": "secret.toml"}),
        client.post("study", json={**asked, "settings": settings, "factors": [EXPONENT]}),
        client.post("study", json={**asked, "factors": [factor]}),
    ):
        assert "is no file of this tuner" in said(response)
    assert not (folder / "secrets").exists()


def test_a_scene_too_large_to_be_waited_for_is_saved(client: httpx.Client) -> None:
    settings = {"changes": {"size": [16384, 16384], "supersampling": 8}}
    assert "save the scene" in said(client.post("picture", json={"settings": settings}))
    text = client.post("scene.toml", json={"settings": settings}).raise_for_status().text
    assert tomllib.loads(text)["size"] == [16384, 16384]


@pytest.mark.gl
def test_a_study_shows_the_very_bytes_of_the_stage(client: httpx.Client, folder: Path) -> None:
    light = {"name": "second light", "path": "lights.0.azimuth", "levels": [0, 90]}
    asked = {"settings": SETTINGS, "title": "As seen", "folder": "seen", "factors": [EXPONENT, light]}
    answer = client.post("study", json=asked).raise_for_status().json()
    assert answer == {"study": str(folder / "seen" / "study.toml"), "next": f"fakesss run {folder / 'seen'}"}
    shown = build_study(folder / "seen")["stimuli"]
    assert len(shown) == 4
    for entry in shown:
        lights = [{**SETTINGS["changes"]["lights"][0], "azimuth": entry["factors"]["second light"]}]
        levels = {"material.thickness_exponent": entry["factors"]["exponent"], "lights": lights}
        settings = {**SETTINGS, "changes": {**SETTINGS["changes"], **levels}}
        seen = client.post("picture", json={"settings": settings}).raise_for_status().content
        assert (folder / "seen" / "stimuli" / entry["file"]).read_bytes() == seen


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"factors": []}, "factors"),
        ({"factors": [EXPONENT | {"levels": [-1]}]}, 'factor "exponent": level -1: must be >= 0'),
        ({"factors": [EXPONENT | {"path": "material.exponent"}]}, "is no scene field"),
        ({"factors": [EXPONENT | {"path": "size"}]}, "all pictures of a study have one size"),
        ({"title": ""}, "title '': must be words on one line"),
        ({"titel": "a"}, "titel"),
        ({"settings": {"changes": {"material.backlight": "much"}}}, "material.backlight: 'much': must be"),
    ],
)
def test_what_is_wrong_with_a_study_is_one_sentence(
    client: httpx.Client, folder: Path, wrong: dict[str, Any], sentence: str
) -> None:
    asked = {"title": "a", "folder": "wrong", "factors": [EXPONENT], **wrong}
    assert sentence in said(client.post("study", json=asked))
    assert not (folder / "wrong").exists()


def test_a_tuner_without_studies_says_so(tmp_path: Path) -> None:
    with tuned(BASE, tmp_path) as url:
        asked = {"title": "a", "folder": "a", "factors": [EXPONENT]}
        assert "start it with `fakesss tune`" in said(httpx.post(f"{url}study", json=asked))
