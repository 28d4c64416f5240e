"""The Psych-DS dataset: it breaks none of the format's own rules, whatever the study and whoever came."""

import csv
import hashlib
import io
import json
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import httpx
import pytest
from exported_study import COMMENT, JOB, nobody_came, people, write_hostile_study
from hypothesis import given
from hypothesis import strategies as st
from psych_ds_rules import DATA_FILE, broken_rules, data_files
from study_fixture import write_study

from study_server.app import admin_secret
from study_server.exports.export import export_ratings
from study_server.exports.psych_ds import DATA, export_psych_ds, name_of
from study_server.manifest import load_study
from study_server.serve import served
from study_server.storage.database import open_database
from study_server.storage.engines import sqlite_url
from study_server.storage.schema import sessions

CODES = {"completion_code": "SECRET1", "prolific": {"completed": "SECRET2"}, "return_url": "https://x.org/?cc=SECRET3"}


@pytest.fixture(scope="module")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A dataset of people in every state; its study lies beside it."""
    folder = tmp_path_factory.mktemp("dataset")
    study = write_hostile_study(folder / "study", **CODES)
    (study / "study.toml").write_text("secret = 'SECRET1'")
    words = hashlib.sha256((study / "study.toml").read_bytes()).hexdigest()
    path = study / "stimuli" / "manifest.json"
    manifest = json.loads(path.read_text(encoding="utf-8"))
    manifest["study"]["sha256"] = words
    path.write_text(json.dumps(manifest), encoding="utf-8")
    with served(study) as url:
        people(url)
    export_psych_ds(study, folder / "out")
    return folder / "out"


@pytest.fixture
def copy(dataset: Path, tmp_path: Path) -> Path:
    """The dataset, to be broken."""
    return Path(shutil.copytree(dataset, tmp_path / "copy"))


def cells(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_it_breaks_no_rule(dataset: Path) -> None:
    assert broken_rules(dataset) == []
    assert {re.sub(".*description-(.*)_data.csv", r"\1", path.name) for path in data_files(dataset)} == set(DATA)
    assert all(cells(path) for path in data_files(dataset))


def test_it_breaks_no_rule_on_either_database_whether_anybody_came_or_not(tmp_path: Path, database_url: str) -> None:
    study = nobody_came(write_hostile_study(tmp_path / "study"), database_url)
    export_psych_ds(study, tmp_path / "nobody", database_url=database_url)
    with served(study, database_url=database_url) as url:
        people(url)
    export_psych_ds(study, tmp_path / "people", database_url=database_url)
    for folder in (tmp_path / "nobody", tmp_path / "people"):
        assert broken_rules(folder) == []
    nobody, somebody = (sorted(path.name for path in data_files(tmp_path / name)) for name in ("nobody", "people"))
    assert nobody == somebody
    for name in nobody:
        first, then = ((tmp_path / folder / "data" / name).read_text() for folder in ("nobody", "people"))
        assert first.splitlines()[0] == then.splitlines()[0]


def edit(name: str, change: Callable[[str], str]) -> Callable[[Path], object]:
    def broken(folder: Path) -> None:
        path = next(folder.glob(name))
        path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")

    return broken


def told(change: Callable[[dict], object]) -> Callable[[Path], object]:
    def changed(text: str) -> str:
        description = json.loads(text)
        change(description)
        return json.dumps(description)

    return edit("dataset_description.json", changed)


def renamed(old: str, new: str) -> Callable[[Path], object]:
    return lambda folder: next(folder.glob(old)).rename(folder / new)


TRIALS = "data/*-trials_data.csv"
BREAKS: dict[str, Callable[[Path], object]] = {
    "MISSING_DATASET_DESCRIPTION": lambda folder: (folder / "dataset_description.json").unlink(),
    "MISSING_README_DOC": lambda folder: (folder / "README.md").unlink(),
    "MISSING_CHANGES_DOC": lambda folder: (folder / "CHANGES.md").unlink(),
    "MISSING_PSYCHDSIGNORE": lambda folder: (folder / ".psychds-ignore").unlink(),
    "MISSING_DATA_DIRECTORY": renamed("data", "documentation/data"),
    "MISSING_MATERIALS_DIRECTORY": lambda folder: shutil.rmtree(folder / "materials"),
    "MISSING_DOCUMENTATION_DIRECTORY": lambda folder: shutil.rmtree(folder / "documentation"),
    "MISSING_DATAFILE": lambda folder: [path.unlink() for path in data_files(folder)],
    "WRONG_METADATA_LOCATION": lambda folder: shutil.copy(folder / "dataset_description.json", folder / "data"),
    "JSON_ENCODING_ERROR": lambda folder: (folder / "dataset_description.json").write_bytes(b'{"name": "\xff"}'),
    "INVALID_JSON_FORMATTING": edit("dataset_description.json", lambda text: text[:-5]),
    "INVALID_JSONLD_FORMATTING": told(lambda it: it.pop("@context")),
    "MISSING_DATASET_TYPE": told(lambda it: it.pop("@type")),
    "INCORRECT_DATASET_TYPE": told(lambda it: it.update({"@type": "DataCatalog"})),
    "JSON_KEY_REQUIRED": told(lambda it: it.pop("description")),
    "INVALID_SCHEMAORG_PROPERTY": told(lambda it: it["variableMeasured"][0].update(levels=[1])),
    "OBJECT_TYPE_MISSING": told(lambda it: it["variableMeasured"][0].pop("@type")),
    "CSV_COLUMN_MISSING_FROM_METADATA": told(lambda it: it["variableMeasured"].pop()),
    "VARIABLE_MISSING_FROM_CSV_COLUMNS": told(lambda it: it["variableMeasured"].append("mood")),
    "FILENAME_KEYWORD_FORMATTING_ERROR": renamed(TRIALS, "data/study-A_description-the_trials_data.csv"),
    "FILENAME_UNOFFICIAL_KEYWORD_WARNING": renamed(TRIALS, "data/mood-good_data.csv"),
    "FILE_NOT_CHECKED": lambda folder: (folder / "notes.txt").write_text("of mine"),
    "FILE_EMPTY": lambda folder: (folder / "README.md").write_text(""),
    "CSV_FORMATTING_ERROR": edit(TRIALS, lambda text: text + '"a"b'),
    "CSV_HEADER_MISSING": edit(TRIALS, lambda text: ""),
    "CSV_HEADER_REPEATED": edit(TRIALS, lambda text: text.replace("participant", "session", 1)),
    "CSV_HEADER_LENGTH_MISMATCH": edit(TRIALS, lambda text: text + "1,2,3\n"),
    "ROWID_VALUES_NOT_UNIQUE": edit(TRIALS, lambda text: text + text.splitlines(keepends=True)[-1]),
}


@pytest.mark.parametrize("rule", BREAKS)
def test_the_rules_can_be_broken(copy: Path, rule: str) -> None:
    BREAKS[rule](copy)
    assert rule in broken_rules(copy)


@given(title=st.text(min_size=1))
def test_every_title_gives_legal_names(title: str) -> None:
    assert re.fullmatch(DATA_FILE, f"study-{name_of(SimpleNamespace(title=title))}_description-trials_data.csv")


def test_a_variable_says_unit_range_and_values(dataset: Path) -> None:
    description = json.loads((dataset / "dataset_description.json").read_text(encoding="utf-8"))
    variables = {variable["name"]: variable for variable in description["variableMeasured"]}
    assert variables["rt_ms"]["unitText"] == "ms"
    assert (variables["rating"]["minValue"], variables["rating"]["maxValue"]) == (1, 7)
    assert variables["question"]["valueReference"] == ['looks, "soft"', "translucent", "check"]
    assert variables["about_age"]["valueReference"] == ["under 18", "25-34"]
    assert all(len(variable["description"]) > 10 for variable in variables.values())
    assert description["name"] == 'Wie "durchscheinend" ist Grün, 100%?'
    assert not {"author", "license", "citation"} & set(description)


def test_the_codebook_describes_each_column_of_each_file(dataset: Path) -> None:
    described = cells(dataset / "documentation" / "codebook.csv")
    for path in data_files(dataset):
        header = next(csv.reader(io.StringIO(path.read_text(encoding="utf-8"))))
        assert [row["column"] for row in described if row["table"] == path.name] == header


def test_a_comment_survives_and_cannot_be_run(dataset: Path) -> None:
    people_told = cells(next(dataset.glob("data/*participants_data.csv")))
    assert "'" + COMMENT.replace("\r\n", "\n") in [row["comments"] for row in people_told]
    assert "'" + JOB.replace("\r", "\n") in [row["about_job"] for row in people_told]


def test_no_codes_no_addresses_of_participants_no_secrets(dataset: Path) -> None:
    everything = b"".join(path.read_bytes() for path in dataset.rglob("*") if path.is_file())
    assert b"SECRET" not in everything
    assert not (dataset / "materials" / "study.toml").exists()
    with open_database(sqlite_url(dataset.parent / "study" / "ratings.sqlite")).reading() as connection:
        found = connection.execute(sessions.select()).mappings().all()
    secrets = [row[name] for row in found for name in ("token", "completion_code") if row[name]]
    assert len(secrets) >= 5
    assert not [secret for secret in secrets if secret.encode() in everything]


def test_the_materials_are_the_study(dataset: Path, tmp_path: Path) -> None:
    built = load_study(dataset / "materials")
    assert built.identity == load_study(dataset.parent / "study").identity
    plain = write_study(tmp_path / "plain")
    (plain / "study.toml").write_text("title = 'x'")
    path = plain / "stimuli" / "manifest.json"
    sha256 = hashlib.sha256(b"title = 'x'").hexdigest()
    path.write_text(re.sub('"sha256": "[0-9a-f]+"', f'"sha256": "{sha256}"', path.read_text(), count=1))
    export_psych_ds(nobody_came(plain), tmp_path / "out")
    assert (tmp_path / "out" / "materials" / "study.toml").read_text() == "title = 'x'"
    (plain / "study.toml").write_text("title = 'y'")
    export_psych_ds(plain, tmp_path / "later")
    assert not (tmp_path / "later" / "materials" / "study.toml").exists()


def test_no_network_address_and_no_browser_name_is_published(dataset: Path, tmp_path: Path) -> None:
    """The study stores both; the plain export has them."""
    plain, *_ = export_ratings(dataset.parent / "study", tmp_path)
    stored = cells(plain.with_name("participants.csv"))[0]
    assert stored["address"] == "127.0.0.1"
    assert stored["browser"].startswith("python-httpx")
    for path in dataset.rglob("*"):
        if path.is_file() and path.suffix != ".png":
            text = path.read_text(encoding="utf-8")
            assert stored["address"] not in text
            assert stored["browser"] not in text
    assert not {"address", "browser"} & set(cells(next(dataset.glob("data/*participants_data.csv")))[0])


def test_again_into_the_same_folder(dataset: Path, copy: Path) -> None:
    told(lambda it: it.update(license="CC-BY-4.0", name="old"))(copy)
    export_psych_ds(dataset.parent / "study", copy)
    description = json.loads((copy / "dataset_description.json").read_text(encoding="utf-8"))
    assert (description["license"], description["name"][:3]) == ("CC-BY-4.0", "Wie")
    changes = (copy / "CHANGES.md").read_text()
    assert (changes.count("# Changes\n"), changes.count("\n## ")) == (1, 2)
    names = [[row["row_id"] for row in cells(next(folder.glob(TRIALS)))] for folder in (dataset, copy)]
    assert names[0] == names[1]
    assert broken_rules(copy) == []


def test_the_zip_is_the_folder(dataset: Path, tmp_path: Path) -> None:
    study = Path(shutil.copytree(dataset.parent / "study", tmp_path / "study"))
    (study / "study.toml").unlink()
    with served(study) as url:
        reply = httpx.get(
            f"{url}/admin/export/psych-ds.zip", headers={"Authorization": f"Bearer {admin_secret(study)}"}
        )
        assert httpx.get(f"{url}/admin/export/psych-ds.zip").status_code == 401
    assert reply.status_code == 200
    assert reply.headers["content-length"] == str(len(reply.content))
    with zipfile.ZipFile(io.BytesIO(reply.content)) as archive:
        assert archive.testzip() is None
        archive.extractall(tmp_path / "zip")
    (unpacked,) = (tmp_path / "zip").iterdir()
    assert unpacked.name == "WieDurchscheinendIstGrun100"
    assert broken_rules(unpacked) == []
    files = {path.relative_to(dataset) for path in dataset.rglob("*") if path.is_file()}
    assert {path.relative_to(unpacked) for path in unpacked.rglob("*") if path.is_file()} == files
    for file in (file for file in files if file.parts[0] in ("data", "materials", "documentation")):
        assert (unpacked / file).read_bytes() == (dataset / file).read_bytes()


def test_the_command_writes_it(dataset: Path, tmp_path: Path) -> None:
    study = str(dataset.parent / "study")
    command = [sys.executable, "-m", "fakesss", "export", study, "--format", "psych-ds", "-o", str(tmp_path), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert str(tmp_path / "dataset_description.json") in json.loads(done.stdout)["files"]
    assert broken_rules(tmp_path) == []
