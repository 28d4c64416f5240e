"""A study is checked before anybody is let in: one sentence for whatever is wrong with the folder."""

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest
from study_fixture import write_study

from fakesss.problem import BadInput
from study_server.app import create_app
from study_server.exports.export import export_ratings
from study_server.manifest import load_study, study_changed


def edit(study: Path, change: Any) -> None:
    path = study / "stimuli" / "manifest.json"
    manifest = json.loads(path.read_text())
    change(manifest)
    path.write_text(json.dumps(manifest))


def test_pictures_are_found_by_id_and_hash(study: Path) -> None:
    built = load_study(study)
    first = built.stimuli[0]
    assert built.by_id["img01"] is first
    assert built.by_hash[first.sha256] is first
    assert first.bytes == first.path.stat().st_size


def test_not_built(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"manifest\.json: no such file; run `fakesss build"):
        load_study(tmp_path)


def test_a_changed_picture_is_refused(study: Path) -> None:
    path = study / "stimuli" / "img02.png"
    path.write_bytes(path.read_bytes() + b"x")
    with pytest.raises(BadInput, match=r"img02\.png: is not the picture that was built"):
        load_study(study)


def test_a_missing_picture_is_refused(study: Path) -> None:
    (study / "stimuli" / "img02.png").unlink()
    with pytest.raises(BadInput, match=r"img02\.png: cannot be read"):
        load_study(study)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda m: m.pop("stimuli"), "is not a manifest of format 1"),
        (lambda m: m.update(format=2), "format 2"),
        (lambda m: m.update(stimuli=[]), "holds no stimuli"),
        (lambda m: m["stimuli"].append(m["stimuli"][0]), "two stimuli share an id"),
        (lambda m: m["stimuli"][0].update(file="../../secret.png"), "lies outside the folder"),
        (lambda m: m["study"].update(survey={"practise": 3}), 'survey.practise: unknown key; did you mean "practice"?'),
        (lambda m: m["study"].update(seed="x"), "is not a manifest"),
    ],
)
def test_a_manifest_that_is_none(study: Path, change: Any, sentence: str) -> None:
    edit(study, change)
    with pytest.raises(BadInput) as problem:
        load_study(study)
    assert sentence in str(problem.value)


def test_a_study_edited_after_the_build_is_exported_but_not_served(study: Path, tmp_path: Path) -> None:
    path = study / "study.toml"
    assert not study_changed(load_study(study))  # no study.toml: nothing to compare
    path.write_text("title = 'as built'")
    edit(study, lambda m: m["study"].update(sha256=hashlib.sha256(path.read_bytes()).hexdigest()))
    assert not study_changed(load_study(study))
    create_app(study)
    path.write_text("title = 'edited'")
    assert study_changed(load_study(study))
    with pytest.raises(BadInput, match=r"study\.toml: has changed since the pictures were built; run `fakesss build"):
        create_app(study)
    assert export_ratings(study, tmp_path / "out")


def test_other_words_or_pictures_make_another_study(tmp_path: Path) -> None:
    one = load_study(write_study(tmp_path / "a"))
    assert one.identity == load_study(write_study(tmp_path / "b")).identity
    assert one.identity != load_study(write_study(tmp_path / "c", size=64)).identity
    assert one.identity != load_study(write_study(tmp_path / "d", survey={"practice": 2})).identity


def test_more_instructed_items_than_find_a_place(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"study\.toml: survey\.checks: 3: must be <= 2, half of the pictures shown"):
        load_study(write_study(tmp_path, 4, survey={"checks": 3}))
    assert load_study(write_study(tmp_path, 4, survey={"checks": 3, "blocks": "by-question"}))


def test_a_picture_repeated_twice_is_no_study_of_ours(tmp_path: Path) -> None:
    write_study(tmp_path, 3)
    path = tmp_path / "stimuli" / "manifest.json"
    manifest = json.loads(path.read_text())
    for entry in manifest["stimuli"][1:]:
        entry |= {"role": "repeat", "same_picture_as": "img01"}
    path.write_text(json.dumps(manifest))
    with pytest.raises(BadInput, match='"img03" repeats "img01", which cannot be repeated; run `fakesss build'):
        load_study(tmp_path)
