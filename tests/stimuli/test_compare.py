"""Path-traced pictures in study.toml: what is accepted, the one sentence for what is not, and how they are built."""

from pathlib import Path
from typing import Any

import pytest
import trimesh
from test_build import STUDY, content, drawn_ids
from test_study import FACTOR, load

from fakesss.offline import path_tracing
from fakesss.offline.settings import PathTracing
from fakesss.problem import BadInput
from stimuli import offline
from stimuli.build import build, verify
from stimuli.design import stimuli_of

SKIN = '[[compare]]\nrenderer = "path-traced"\nmedium = "skin1"\nsize_mm = 20\nsamples = 8\n'
HEAD = STUDY.split("[[factor]]")[0].replace("[48, 40]", "[24, 20]")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A study of one path-traced picture and of one of ours, with a cache of its own."""
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "cache"))
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "study.toml").write_text(f"{HEAD}{FACTOR}{SKIN}", encoding="utf-8")
    return tmp_path / "study"


def rounds(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The rounds that are really traced."""
    traced: list[int] = []
    trace = path_tracing.Tracer.__call__

    def noting(self: Any, number: int) -> Any:
        traced.append(number)
        return trace(self, number)

    monkeypatch.setattr(path_tracing.Tracer, "__call__", noting)
    return traced


def test_a_path_traced_picture_is_the_scene_with_fields_set_and_no_picture_of_ours(tmp_path: Path) -> None:
    study = load(tmp_path, f'title = "x"\n{SKIN}set = {{ light.azimuth = 180 }}\n{SKIN}denoise = true\n')
    behind, base = stimuli_of(study)
    assert (behind.id, behind.role, behind.label, behind.rows) == ("img01", "compare", "path-traced skin1", ())
    assert behind.scene == study.scene.replace({"light.azimuth": 180})
    assert behind.path_tracing == PathTracing(medium="skin1", size_mm=20, samples=8)
    assert base.scene == study.scene
    assert base.label == "path-traced skin1, denoised"


def test_a_denoised_picture_s_label_says_so_whatever_else_it_says(tmp_path: Path) -> None:
    labels = ["marble, not denoised", "the one, denoised", "mine"]
    text = "".join(f'{SKIN}denoise = true\nlabel = "{label}"\n' for label in labels)
    found = [s.label for s in stimuli_of(load(tmp_path, f'title = "x"\n{text}'))]
    assert found == ["marble, not denoised, denoised", "the one, denoised", "mine, denoised"]


@pytest.mark.parametrize(
    ("second", "name"),
    [
        (SKIN.replace("samples = 8", "samples = 12"), "path-traced skin1"),
        ('[[compare]]\nimage = "path-traced skin1"\n', "path-traced skin1"),
        (f'{SKIN}label = "path-traced skin1"\nseed = 1\n', "path-traced skin1"),
    ],
)
def test_no_two_pictures_have_one_name(tmp_path: Path, second: str, name: str) -> None:
    with pytest.raises(BadInput) as caught:
        load(tmp_path, f'title = "x"\n{SKIN}{second}')
    assert str(caught.value) == f'study.toml: compare label "{name}" is used twice; give each its own'


def test_the_same_scene_in_two_media_is_two_pictures(tmp_path: Path) -> None:
    other = SKIN.replace("skin1", "marble")
    found = stimuli_of(load(tmp_path, f'title = "x"\n[design]\nrepeats = 1\n{SKIN}{other}{SKIN}label = "again"\n'))
    assert [s.same_picture_as for s in found[:3]] == [None, None, "img01"]
    assert found[3].path_tracing is not None  # one shown again is path-traced too


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", 'study.toml: compare[1]: needs an origin: image = "file.png" or renderer = "path-traced"'),
        ('image = "a.png"\nrenderer = "path-traced"\nmedium = "skin1"', "compare[1]: has an image and a renderer"),
        ('image = "a.png"\nmedium = "skin1"', "compare[1]: medium is of path-traced pictures and this one is a file"),
        ('image = "a.png"\nset.exposure = 1', "compare[1]: set is of path-traced pictures and this one is a file"),
        ('renderer = "path-traced"', 'compare[1]: medium is missing; add one, for example medium = "marble"'),
        ('renderer = "pathtraced"\nmedium = "skin1"', "compare[1].renderer: 'pathtraced': must be 'path-traced'"),
        (
            'renderer = "path-traced"\nmedium = "marbel"',
            'compare[1].medium: \'marbel\': "marbel" is no measured medium; did you mean "marble"?',
        ),
        ('renderer = "path-traced"\nmedium = "skin1"\nsampels = 8', 'sampels: unknown key; did you mean "samples"?'),
        ('renderer = "path-traced"\nmedium = "skin1"\nsize_mm = 0', "compare[1].size_mm: 0: must be > 0"),
        (
            'renderer = "path-traced"\nmedium = "skin1"\nset = { light.azimut = 1 }',
            'study.toml: compare "path-traced skin1": path "light.azimut" is no scene field; did you mean',
        ),
        (
            'renderer = "path-traced"\nlabel = "mine"\nmedium = "skin1"\nset = { size = [9, 9] }',
            'study.toml: compare "mine": size = [9, 9]: all pictures of a study have one size; set it in [scene]',
        ),
        (
            'renderer = "path-traced"\nlabel = "mine"\nmedium = "skin1"\nset = { alpha = true }',
            'study.toml: compare "mine": a browser would show its page through the picture; set alpha = false',
        ),
    ],
)
def test_bad_pictures_of_other_origin_get_one_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    with pytest.raises(BadInput) as caught:
        load(tmp_path, f'title = "x"\n{FACTOR}[[compare]]\n{text}\n')
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        (
            'object = "open.ply"',
            'compare "path-traced skin1": object .*open.ply.*: its surface is open.*close the',
        ),
        ('light.kind = "spot"', 'compare "path-traced skin1": light.kind: path-traced pictures have no spots; make it'),
        ("camera.near = 3.7", 'compare "path-traced skin1": camera: its clip planes may cut the object open'),
    ],
)
def test_what_cannot_be_traced_is_said_before_anything_is_drawn(folder: Path, fields: str, sentence: str) -> None:
    ball = trimesh.creation.icosphere(2)
    trimesh.Trimesh(ball.vertices, ball.faces[:-3]).export(folder / "open.ply")
    with (folder / "study.toml").open("a") as file:
        file.write(f"set = {{ {fields} }}\n")
    with pytest.raises(BadInput, match=rf"^study\.toml: {sentence}"):
        build(folder, quiet=True)
    assert not list((folder / "stimuli" / ".build").glob("*.png"))


def test_without_mitsuba_the_mend_is_named(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def version(name: str) -> str:
        raise path_tracing.PackageNotFoundError(name)

    monkeypatch.setattr(path_tracing, "version", version)
    with pytest.raises(BadInput, match=r"compare .*: Mitsuba is not installed; pip install 'fakesss\[offline\]'"):
        build(folder, quiet=True)


@pytest.mark.gl
def test_it_is_traced_once_and_stands_in_the_manifest(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    traced = rounds(monkeypatch)
    entry = build(folder, quiet=True)["stimuli"][-1]
    assert traced == [0, 1]
    assert "img03 (path-traced skin1) is path-traced now, which takes about a minute" in caplog.text
    assert (entry["role"], entry["passes"], entry["rows"]) == ("compare", [], [])
    assert entry["scene"]["object"] == "torus:4000"
    origin = entry["origin"]
    assert (origin["renderer"], origin["medium"], origin["size_mm"]) == ("path-traced", "skin1", 20)
    assert (origin["samples"], origin["denoised"]) == (8, False) and origin["noise"] > 0
    assert "seconds" not in origin and "shipped" not in origin
    good = content(folder)
    build(folder, force=True, quiet=True)
    (folder.parent / "copy").mkdir()
    (folder.parent / "copy" / "study.toml").write_bytes((folder / "study.toml").read_bytes())
    build(folder.parent / "copy", jobs=2, quiet=True)
    assert content(folder) == content(folder.parent / "copy") == good
    assert traced == [0, 1]  # all the rest came from the cache
    (folder / "study.toml").write_text(f"{HEAD}{FACTOR}{SKIN}set.exposure = 1.1\n", encoding="utf-8")
    assert build(folder, quiet=True)["stimuli"][-1]["sha256"] != entry["sha256"]
    assert traced == [0, 1]


@pytest.mark.gl
def test_an_interrupted_picture_goes_on_where_it_stopped(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    trace = path_tracing.Tracer.__call__

    def interrupted(self: Any, number: int) -> Any:
        if number == 1:
            raise KeyboardInterrupt
        return trace(self, number)

    monkeypatch.setattr(path_tracing.Tracer, "__call__", interrupted)
    with pytest.raises(KeyboardInterrupt):
        build(folder, quiet=True)
    assert len(list((folder / "stimuli" / ".build").glob("*.json"))) == 2  # ours are drawn first
    monkeypatch.setattr(path_tracing.Tracer, "__call__", trace)
    traced, drawn = rounds(monkeypatch), drawn_ids(monkeypatch)
    build(folder, quiet=True)
    assert (traced, drawn) == ([1], ["img03"])


@pytest.mark.gl
def test_verify_traces_again_only_when_asked(
    folder: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    build(folder, quiet=True)
    traced = rounds(monkeypatch)
    assert verify(folder, quiet=True) == [] and "not traced again" not in caplog.text  # made again from the cache
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "elsewhere"))
    assert verify(folder, quiet=True) == []
    assert "img03: its file is compared, its light not traced again; --offline does that" in caplog.text
    assert traced == []
    assert verify(folder, offline=True, quiet=True) == []
    assert traced == [0, 1]
    (folder / "stimuli" / "img03.png").write_bytes(b"another")
    assert verify(folder, quiet=True) == ["img03: img03.png is not the picture of the manifest; run `fakesss build`"]


@pytest.mark.gl
def test_our_shaders_make_it_stale_only_where_they_draw_its_highlights(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "study.toml").write_text(f'{HEAD}{SKIN}{SKIN}label = "matt"\nhighlights = false\n', encoding="utf-8")
    build(folder, quiet=True)
    drawn = drawn_ids(monkeypatch)
    monkeypatch.setattr("stimuli.picture.source_sha256", lambda tracing=False: "the same" if tracing else "another")
    build(folder, quiet=True)
    drawn.clear()
    monkeypatch.setattr("stimuli.picture.source_sha256", lambda tracing=False: "the same" if tracing else "a third")
    build(folder, quiet=True)
    assert drawn == ["img01"]
    monkeypatch.setattr("stimuli.picture.source_sha256", lambda tracing=False: "a tracer" if tracing else "a third")
    build(folder, quiet=True)
    assert drawn == ["img01", "img01", "img02"]
    drawn[:] = ["img01"]
    monkeypatch.setattr(offline, "installed", lambda package: "4.0")
    build(folder, quiet=True)
    assert drawn == ["img01", "img01", "img02"]
