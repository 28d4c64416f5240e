"""The export: fixed columns, every expected row, nothing a spreadsheet would run, nothing undescribed."""

import codecs
import csv
import re
import tomllib
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from exported_study import nobody_came, people, write_hostile_study
from pydantic import BaseModel
from study_fixture import write_study
from survey_client import ABOUT, Participant

from fakesss.problem import BadInput
from study_server.answers import Answer, Display, Posted
from study_server.exports.cells import FORMULA_STARTS, ROWS_AT_ONCE, cell, csv_text, iso
from study_server.exports.codebook import TABLES, WIDE, columns_of
from study_server.exports.columns import PARTICIPANTS, RATINGS
from study_server.exports.export import ROWS, export_ratings, snapshot
from study_server.manifest import load_study
from study_server.serve import served
from study_server.settings import AboutField, Question, Survey, check_survey
from study_server.simulation.raters import Effects, QuestionEffects, default_effects, load_effects
from study_server.storage import schema

DOCS = Path(__file__).parents[2] / "docs"
Exported = Callable[..., list[dict[str, str]]]


def test_the_ratings_have_the_documented_columns_in_order() -> None:
    text = (DOCS / "architecture.md").read_text(encoding="utf-8")
    listed = re.search(r"long CSV: `([^`]+)`", text)
    assert listed
    assert [name.strip() for name in listed[1].split(",")] == list(RATINGS)


def test_every_column_and_table_is_in_the_docs() -> None:
    text = (DOCS / "survey.md").read_text(encoding="utf-8")
    missing = [name for table in schema.tables.tables.values() for name in (table.name,) if f"`{name}`" not in text]
    missing += [name for name in RATINGS if f"`{name}`" not in text]
    assert not missing


def test_unanswered_pictures_are_empty_ratings(url: str, study: Path, tmp_path: Path) -> None:
    Participant(url).to_trials().rate(6)
    export_ratings(study, tmp_path / "out")
    frame = pd.read_csv(tmp_path / "out" / "ratings.csv")
    assert list(frame.columns) == list(RATINGS)
    assert len(frame) == 6
    assert frame.rating.tolist()[:2] == [6, 6]
    assert frame.rating[2:].isna().all()
    assert frame.trial.tolist() == [1, 1, 2, 2, 3, 3]


def test_every_table_has_a_codebook_that_describes_each_column(url: str, study: Path, tmp_path: Path) -> None:
    Participant(url).to_trials().to_end()
    paths = export_ratings(study, tmp_path / "out")
    assert [path.stem for path in paths] == list(TABLES)
    described = pd.read_csv(tmp_path / "out" / "codebook.csv")
    assert described.description.str.len().min() > 5
    assert set(described.type) <= {"text", "integer", "number", "time", "json"}
    for path in paths:
        frame = pd.read_csv(path)
        assert len(frame) > 0
        assert list(frame.columns) == described.column[described.table == path.name].tolist()


@pytest.fixture(scope="module")
def hostile(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The export of a study with odd names, of people in every state; the study lies beside it."""
    folder = tmp_path_factory.mktemp("hostile")
    study = write_hostile_study(folder / "study")
    with served(study) as url:
        people(url)
    export_ratings(study, folder / "out")
    return folder / "out"


@pytest.mark.parametrize("table", TABLES)
def test_no_cell_is_without_a_column(hostile: Path, table: str) -> None:
    """What a row has beside its columns would be lost without a word."""
    beside = {"events": {"id"}, "wide": set(PARTICIPANTS)}.get(table, set())
    with snapshot(hostile.parent / "study", "live", None) as source:
        known = columns_of(table, source.study)
        for row in ROWS[table](source):
            assert set(row) - set(known) <= beside
            for name, value in row.items():
                if name in known and known[name].values and value not in (None, ""):
                    assert str(cell(value)) in known[name].values, (name, value)
            for name, column in known.items():
                assert row.get(name) not in (None, "") or column.missing, f"{name} is empty, and nobody says why"


@pytest.mark.parametrize("table", TABLES)
def test_headers_follow_from_the_study_alone(hostile: Path, tmp_path: Path, table: str) -> None:
    study = nobody_came(write_hostile_study(tmp_path / "study"))
    export_ratings(study, tmp_path / "nobody")
    with (hostile / f"{table}.csv").open() as some, (tmp_path / "nobody" / f"{table}.csv").open() as none:
        assert some.readline() == none.readline()


@pytest.mark.parametrize("table", TABLES)
def test_pandas_and_csv_read_the_same_cells(hostile: Path, table: str) -> None:
    path = hostile / f"{table}.csv"
    assert not path.read_bytes().startswith(codecs.BOM_UTF8)
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file, strict=True)
    with path.open(encoding="utf-8") as file:  # as most people open it: every \r ends a line
        assert list(csv.reader(file, strict=True)) == [header, *rows]
    frame = pd.read_csv(path, dtype=str, keep_default_na=False)
    assert list(frame.columns) == header
    assert frame.to_numpy().tolist() == rows
    assert not [text for row in (header, *rows) for text in row if runs(text)]


def runs(text: str) -> bool:
    """Whether a spreadsheet would run this cell; numbers below zero are numbers."""
    return text.startswith(FORMULA_STARTS) and not re.fullmatch(r"-?[0-9.]+(e[+-][0-9]+)?", text)


def test_what_was_never_due_is_told_from_what_was_left_unanswered(hostile: Path) -> None:
    rows = pd.read_csv(hostile / "ratings.csv")
    told = pd.read_csv(hostile / "participants.csv").set_index("session")
    stopped = told[(told.step == "trials")].index.item()
    rows = rows[rows.session == stopped]
    assert rows.trial[rows.rating.notna()].unique().tolist() == [1, 2]
    assert rows[rows.rating.isna()].shown_at.isna().all()
    assert told.trials_answered[stopped] + 1 == rows.trial[rows.rating.isna()].min()
    assert told.step.tolist() == ["done", "trials", "about", "screened_out", "withdrawn"]


def test_wide_has_each_answer_of_the_long_table_in_a_column_of_its_own(hostile: Path) -> None:
    long, wide = (pd.read_csv(hostile / f"{name}.csv") for name in ("ratings", "wide"))
    pictures = ["img01", "img02", "img03", "img04", "img01r", "img02r"]
    names = [f"{picture}__{question}" for picture in pictures for question in ('looks, "soft"', "translucent")]
    assert list(wide.columns) == [*WIDE, *names, "check_1", "check_2"]
    assert wide.session.tolist() == long.session.unique().tolist()
    given = long[long.question != "check"]
    melted = wide.melt("session", names, "column", "rating").set_index(["session", "column"]).rating
    keys = pd.MultiIndex.from_arrays([given.session, given.stimulus + "__" + given.question])
    assert melted.loc[keys].fillna(0).tolist() == given.rating.fillna(0).tolist()


def test_the_stimuli_bring_their_levels(study: Path, tmp_path: Path) -> None:
    export_ratings(nobody_came(study), tmp_path / "out")
    frame = pd.read_csv(tmp_path / "out" / "stimuli.csv")
    assert frame["factor_thickness exponent"].tolist() == [25, 18, 30]
    assert pd.read_csv(tmp_path / "out" / "ratings.csv").empty


def test_a_comment_cannot_become_a_formula(url: str, exported: Exported) -> None:
    person = Participant(url).to_trials()
    while person.state["step"] == "trials":
        person.rate()
    person.post("comments", comments='=HYPERLINK("http://x")\nsecond, line')
    assert exported("participants")[0]["comments"] == '\'=HYPERLINK("http://x")\nsecond, line'


def test_nothing_of_practice_is_exported(url: str, exported: Exported) -> None:
    """Neither an answer that was changed, nor one that was refused."""
    person = Participant(url).consent()
    for step, told in (("about", ABOUT), ("screen", {}), ("instructions", {})):
        person.post(step, **told)
    for step in ("practice", "trials"):
        assert person.state["step"] == step
        body = person.answers()
        assert person.send(person.answers(stimulus_sha256="0" * 64)).status_code == 409
        person.rate(4)
        body["answers"][0]["rating"] = 5
        assert person.send(body | {"submission": "another-one"}).json()["saved"][0]["revision"] == 1
        if step == "practice":
            person.post("ready")
    assert [event["kind"] for event in exported("events")] == ["started", "refused", "revised"]
    assert {row["trial"] for row in exported("displays")} == {"1"}


def test_the_codebook_says_what_forgetting_empties(hostile: Path) -> None:
    book = pd.read_csv(hostile / "codebook.csv", keep_default_na=False)
    people_told = book[book.table == "participants.csv"].set_index("column").missing
    forgotten = people_told[people_told.str.contains("fakesss forget")].index
    assert set(forgotten) == {"comments", "about_job", "address", "browser"}


@pytest.mark.parametrize("value", ["=1", "+1", "-1", "@x", "\tx", "\nx"])
def test_formula_cells(value: str) -> None:
    assert cell(value) == "'" + value


def test_every_line_in_a_cell_ends_in_a_line_feed() -> None:
    assert cell("a\r\nb\rc\n\rd") == "a\nb\nc\n\nd"
    assert cell("\r=1") == "'\n=1"


def test_numbers_stay_numbers() -> None:
    assert (cell(-1.5), cell(-2), cell(None), cell(0.1 + 0.2)) == ("-1.5", -2, None, "0.3")


def test_pieces_join_to_the_whole() -> None:
    rows = [{"a": number, "b": "x"} for number in range(2 * ROWS_AT_ONCE + 1)]
    pieces = list(csv_text(["a", "b"], rows))
    assert len(pieces) == 3
    assert len(list(csv.reader("".join(pieces).splitlines()))) == len(rows) + 1


def test_iso_is_utc_with_milliseconds() -> None:
    assert iso(1_700_000_000.1234) == "2023-11-14T22:13:20.123Z"
    assert iso(None) is None


def test_a_folder_that_cannot_be_written(study: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(BadInput, match="cannot be written"):
        export_ratings(nobody_came(study), tmp_path / "file" / "out")


def test_another_version_of_the_study_is_not_exported_as_this_one(url: str, study: Path, tmp_path: Path) -> None:
    write_study(study, survey={"practice": 2})
    with pytest.raises(BadInput, match="another version of this study"):
        export_ratings(study, tmp_path / "out")


@pytest.mark.parametrize("model", [Question, AboutField, Survey, Answer, Display, Posted, Effects, QuestionEffects])
def test_every_key_is_in_the_docs(model: type[BaseModel]) -> None:
    text = (DOCS / "survey.md").read_text(encoding="utf-8")
    assert [name for name in model.model_fields if not re.search(rf"\b{name}\b", text)] == []


def test_the_effects_in_the_docs_are_the_defaults(tmp_path: Path) -> None:
    text = (DOCS / "survey.md").read_text(encoding="utf-8")
    example = next(block for block in re.findall(r"```toml\n(.*?)```", text, re.DOTALL) if "person_sd" in block)
    path = tmp_path / "effects.toml"
    path.write_text(example.replace("intercept = 4.0", ""), encoding="utf-8")
    study = load_study(write_study(tmp_path / "study", 9))
    assert load_effects(path, study) == default_effects(study)


def test_the_study_in_the_docs_is_valid() -> None:
    text = (DOCS / "survey.md").read_text(encoding="utf-8")
    example = next(block for block in re.findall(r"```toml\n(.*?)```", text, re.DOTALL) if "[[question]]" in block)
    assert check_survey(tomllib.loads(example), "docs").survey.about[0].required
