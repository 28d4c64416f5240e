"""Building: same bytes, nothing drawn twice, interrupted work continued. Real pictures, real files."""

import hashlib
import io
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from PIL import Image

from benchmarks.sweep import AtOnce
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from stimuli import build as building
from stimuli.build import build, verify
from stimuli.store import Store

STUDY = """title = "x"
[scene]
object = "torus:4000"
size = [48, 40]
supersampling = 1
[scene.occlusion]
rays = 16
[[factor]]
name = "backlight"
path = "material.backlight"
levels = [1.2, 0.8]
[[factor]]
name = "exponent"
path = "material.thickness_exponent"
levels = [25, 18]
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "study.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path / "study"


@pytest.mark.gl
def test_a_picture_that_is_not_finite_is_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    render = Renderer.render

    def spoilt(self: Renderer, *args: Any, **kwargs: Any) -> Any:
        drawn = render(self, *args, **kwargs)
        drawn.image[3, 4:9] = np.nan
        return drawn

    monkeypatch.setattr(Renderer, "render", spoilt)
    with pytest.raises(BadInput, match=r"study\.toml: img0\d: 5 pixels hold a value that is not finite.*; change"):
        build(folder, quiet=True)
    assert not (folder / "stimuli" / "manifest.json").exists()


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted((folder / "stimuli").iterdir())}


def drawn_ids(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The ids of the stimuli that the build really draws, in order."""
    ids: list[str] = []
    draw = building.draw

    def noting(stimulus: Any, **kwargs: Any) -> Any:
        ids.append(stimulus.id)
        return draw(stimulus, **kwargs)

    monkeypatch.setattr(building, "draw", noting)
    return ids


def test_two_builds_give_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "again")
    build(folder)
    build(tmp_path / "again", jobs=2)
    assert content(folder) == content(tmp_path / "again")
    assert verify(folder) == []


def test_the_manifest_describes_the_files(folder: Path) -> None:
    manifest = build(folder)
    assert manifest == json.loads((folder / "stimuli" / "manifest.json").read_text())
    assert [entry["id"] for entry in manifest["stimuli"]] == ["img01", "img02", "img03", "img04"]
    for entry in manifest["stimuli"]:
        picture = (folder / "stimuli" / entry["file"]).read_bytes()
        assert hashlib.sha256(picture).hexdigest() == entry["sha256"]
        assert Image.open(io.BytesIO(picture)).size == (entry["width"], entry["height"]) == (48, 40)
        assert b"sRGB" in picture
    assert manifest["stimuli"][2]["same_picture_as"] == "img01"
    assert manifest["stimuli"][2]["sha256"] == manifest["stimuli"][0]["sha256"]
    assert len({entry["sha256"] for entry in manifest["stimuli"]}) == 3
    assert manifest["study"]["sha256"] == hashlib.sha256((folder / "study.toml").read_bytes()).hexdigest()


def test_a_second_build_draws_nothing_and_a_changed_level_only_itself(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    build(folder)
    drawn = drawn_ids(monkeypatch)
    build(folder)
    assert drawn == []
    (folder / "study.toml").write_text(STUDY.replace("18]", "20]"), encoding="utf-8")
    build(folder)
    assert drawn == ["img04"]
    build(folder, force=True)
    assert len(drawn) == 4  # img01 and img03 are one picture


def test_an_interrupted_build_continues(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    draw = building.draw

    def interrupted(stimulus: Any, **kwargs: Any) -> Any:
        if stimulus.id == "img04":
            raise KeyboardInterrupt
        return draw(stimulus, **kwargs)

    monkeypatch.setattr(building, "draw", interrupted)
    with pytest.raises(KeyboardInterrupt):
        build(folder)
    assert not (folder / "stimuli" / "manifest.json").exists()
    monkeypatch.setattr(building, "draw", draw)
    drawn = drawn_ids(monkeypatch)
    build(folder)
    assert drawn == ["img04"]
    assert sorted(content(folder)) == ["img01.png", "img02.png", "img03.png", "img04.png", "manifest.json"]


def test_an_interruption_keeps_pictures_that_are_still_being_written(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    put, draw = Store.put, building.draw

    def slow(self: Store, key: str, drawn: Any) -> None:
        time.sleep(0.2)
        put(self, key, drawn)

    def interrupted(stimulus: Any, **kwargs: Any) -> Any:
        if stimulus.id == "img04":
            raise KeyboardInterrupt
        return draw(stimulus, **kwargs)

    monkeypatch.setattr(Store, "put", slow)
    monkeypatch.setattr(building, "draw", interrupted)
    with pytest.raises(KeyboardInterrupt):
        build(folder)
    assert len(list((folder / "stimuli" / ".build").glob("*.json"))) == 2


def test_a_full_disk_is_one_sentence_and_the_build_continues(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    put, calls = Store.put, []

    def full(self: Store, key: str, drawn: Any) -> None:
        calls.append(key)
        if len(calls) == 2:
            raise BadInput("stimuli: cannot be written (No space left on device); check the folder's space")
        put(self, key, drawn)

    monkeypatch.setattr(Store, "put", full)
    with pytest.raises(BadInput, match="No space left on device"):
        build(folder)
    assert not (folder / "stimuli" / "manifest.json").exists()
    kept = len(list((folder / "stimuli" / ".build").glob("*.json")))
    assert kept == len(calls) - 1
    monkeypatch.setattr(Store, "put", put)
    drawn = drawn_ids(monkeypatch)
    build(folder)
    assert len(drawn) == 3 - kept
    assert verify(folder) == []


def test_the_overlap_changes_no_byte(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(folder, tmp_path / "again")
    build(folder)
    monkeypatch.setattr(building, "Background", AtOnce)
    build(tmp_path / "again")
    assert content(folder) == content(tmp_path / "again")


def dies(task: Any, *, size: Any, folder: Any) -> None:
    os._exit(1)


def test_a_drawing_process_that_dies_is_one_sentence(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(building, "draw_one", dies)
    with pytest.raises(BadInput, match="a drawing process died; build with fewer --jobs"):
        build(folder, jobs=2)


def test_a_tampered_picture_is_drawn_again_and_verify_tells(folder: Path) -> None:
    build(folder)
    before = content(folder)
    (folder / "stimuli" / "img02.png").write_bytes(b"not a picture")
    assert verify(folder) == ["img02: img02.png is not the picture of the manifest; run `fakesss build`"]
    build(folder)
    assert content(folder) == before


def test_a_smaller_design_leaves_no_stray_pictures(folder: Path) -> None:
    build(folder)
    (folder / "study.toml").write_text(STUDY.replace("1.2, 0.8", "1.2"), encoding="utf-8")
    build(folder)
    assert sorted(content(folder)) == ["img01.png", "img02.png", "img03.png", "manifest.json"]


def test_pictures_made_elsewhere_keep_their_pixels(folder: Path) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (40, 48, 3), dtype=np.uint8)
    Image.fromarray(pixels).save(folder / "offline.png")
    (folder / "study.toml").write_text(f'{STUDY}[[compare]]\nimage = "offline.png"\nlabel = "marble"\n')
    entry = build(folder)["stimuli"][-1]
    assert (entry["id"], entry["role"], entry["label"], entry["scene"]) == ("img05", "compare", "marble", None)
    shown = np.asarray(Image.open(folder / "stimuli" / "img05.png").convert("RGB"))
    np.testing.assert_array_equal(shown, pixels)


def test_a_picture_of_another_size_is_refused(folder: Path) -> None:
    Image.new("RGB", (64, 64)).save(folder / "offline.png")
    (folder / "study.toml").write_text(f'{STUDY}[[compare]]\nimage = "offline.png"\n')
    with pytest.raises(BadInput, match=r"offline\.png': is 64x64 but the study's pictures are 48x40; resize it"):
        build(folder)


def test_a_mesh_is_looked_for_beside_the_study_only(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "study.toml").write_text(STUDY.replace("torus:4000", "thing.ply"), encoding="utf-8")
    trimesh.creation.icosphere(1).export(tmp_path / "thing.ply")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(BadInput, match=r'scene\.object "thing\.ply": cannot be read'):
        build(folder)


def test_an_edited_mesh_is_drawn_again(folder: Path) -> None:
    (folder / "study.toml").write_text(STUDY.replace("torus:4000", "thing.ply"), encoding="utf-8")
    trimesh.creation.icosphere(1).export(folder / "thing.ply")
    before = build(folder)["stimuli"][0]["sha256"]
    trimesh.creation.box().export(folder / "thing.ply")
    assert build(folder)["stimuli"][0]["sha256"] != before
    assert verify(folder) == []


@pytest.mark.parametrize("damage", ["other bytes", "no picture", "half a description", "no description"])
def test_a_damaged_waiting_room_is_drawn_again(folder: Path, tmp_path: Path, damage: str) -> None:
    build(folder)
    good, key = (
        content(folder),
        json.loads((folder / "stimuli" / "manifest.json").read_text())["stimuli"][0]["build_key"],
    )
    shutil.rmtree(folder / "stimuli")
    waiting = folder / "stimuli" / ".build"
    waiting.mkdir(parents=True)
    facts = json.dumps({"sha256": hashlib.sha256(b"x").hexdigest(), "width": 1, "height": 1})
    if damage != "no picture":
        (waiting / f"{key}.png").write_bytes(b"y")
    if damage != "no description":
        (waiting / f"{key}.json").write_text(facts[:20] if damage.startswith("half") else facts)
    build(folder)
    assert content(folder) == good


@pytest.mark.parametrize("text", ["{", "[]", '{"format": 1}', '{"format": 2, "stimuli": []}', '{"stimuli": [3]}'])
def test_a_manifest_that_is_none_is_made_again(folder: Path, text: str) -> None:
    build(folder)
    good = content(folder)
    (folder / "stimuli" / "manifest.json").write_text(text)
    with pytest.raises(BadInput, match=r"fakesss build|build the study again"):
        verify(folder)
    build(folder)
    assert content(folder) == good


def test_two_builds_at_once_are_refused_in_one_sentence(folder: Path) -> None:
    with (
        building.one_build_at_a_time(folder / "stimuli" / ".build"),
        pytest.raises(BadInput, match="another build of this study is running"),
    ):
        build(folder)
    build(folder)


def killed_while_writing(*paths: Path) -> None:
    """Begins to write `paths` and dies as by `kill -9`: nothing is tidied up."""
    source = (
        "import os, pathlib, signal, sys\n"
        "from contextlib import ExitStack\n"
        "from fakesss.output import replacing\n"
        "with ExitStack() as begun:\n"
        "    for path in map(pathlib.Path, sys.argv[1:]):\n"
        "        begun.enter_context(replacing(path)).write_bytes(b'half')\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    assert subprocess.run([sys.executable, "-c", source, *map(str, paths)]).returncode == -signal.SIGKILL


def test_what_a_killed_build_left_half_written_is_removed(folder: Path) -> None:
    stimuli = folder / "stimuli"
    (stimuli / ".build").mkdir(parents=True)
    begun = [stimuli / ".build" / f"{'0a' * 32}.{kind}" for kind in ("png", "json")]
    killed_while_writing(*begun, *(stimuli / name for name in ("img01.png", "img01r.png", "manifest.json")))
    assert len(list(stimuli.glob(".*.*.*"))) == 3 and len(list((stimuli / ".build").iterdir())) == 2
    (stimuli / ".notes.png.of_mine").write_text("kept")
    build(folder)
    names = [".notes.png.of_mine", "img01.png", "img02.png", "img03.png", "img04.png", "manifest.json"]
    assert sorted(content(folder)) == names


def test_a_running_build_keeps_what_it_is_writing(folder: Path) -> None:
    waiting = folder / "stimuli" / ".build"
    with building.one_build_at_a_time(waiting):
        killed_while_writing(waiting / f"{'0a' * 32}.png")
        with pytest.raises(BadInput, match="another build"):
            build(folder)
        assert len(list(waiting.glob(".*"))) == 1


def test_levels_without_effect_are_told(folder: Path) -> None:
    turned = STUDY.replace("material.backlight", "camera.azimuth").replace("[1.2, 0.8]", "[0, 360]")
    (folder / "study.toml").write_text(turned, encoding="utf-8")
    manifest = build(folder)
    assert manifest["stimuli"][1]["same_picture_as"] == "img01"
    told = building.levels_without_effect(manifest)
    assert told == ["img02: is the same picture as img01, though made differently"]
    assert build(folder) == manifest


def test_a_study_can_be_copied(folder: Path, tmp_path: Path) -> None:
    build(folder)
    shutil.copytree(folder, tmp_path / "copy")
    folder.rename(tmp_path / "gone")
    assert verify(tmp_path / "copy") == []
