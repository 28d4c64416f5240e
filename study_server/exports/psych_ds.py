"""The export as a Psych-DS 1.5.0 dataset (https://psych-ds.github.io): a folder, or the same as a ZIP file.

Data files under data/, what they hold in dataset_description.json, the codebook under documentation/, and under
materials/ the study itself. wide.csv is left out: it holds nothing that the long table does not. Network addresses and
browser names are left out, because a dataset is made to be published.
"""

import json
import re
import unicodedata
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import IO, Any

from study_server.exports.cells import cell, csv_text
from study_server.exports.codebook import columns_of, described
from study_server.exports.columns import CLIENT, CODEBOOK, Column
from study_server.exports.dataset_words import changes_text, counted, description_of, readme_text
from study_server.exports.export import ROWS, snapshot
from study_server.exports.export_rows import Row, Source
from study_server.manifest import BuiltStudy, study_changed
from study_server.site import Mode
from study_server.storage.staging import staged

CONTEXT = "https://schema.org/"
VERSION = "1.5.0"
IGNORED = "data/raw/\n"

DATA = {
    "trials": "ratings",
    "participants": "participants",
    "displays": "displays",
    "events": "events",
    "stimuli": "stimuli",
}
"""What a data file is called -> the exported table that it holds."""

ROW_IDS = {
    "ratings": ("session", "trial", "question"),
    "participants": ("session",),
    "displays": ("session", "trial"),
    "events": ("id",),
    "stimuli": ("stimulus",),
}
"""The values that together name a row: the same in every later export."""

ROW_ID = Column("name of the row within its file, the same in every later export")

CODES = ("completion_code", "return_url", "prolific")
"""Keys of [survey] with completion codes, which are money to who has them."""


@dataclass(frozen=True)
class Part:
    """One file of the dataset: its path within, and its content in pieces."""

    path: str
    pieces: Iterable[bytes]


def export_psych_ds(
    study_folder: Path, out: Path, *, mode: Mode = "live", database_url: str | None = None
) -> list[Path]:
    """Write the dataset into the folder `out`, made if it is not there; gives the paths of its files.

    In a dataset that is there already, CHANGES.md grows, and what was added by hand to dataset_description.json
    (author, license, citation) stays. Raises `BadInput` as `export_ratings` does.
    """
    out, written = Path(out), []
    with snapshot(Path(study_folder), mode, database_url) as source, staged(out) as folder:
        for part in parts(source, added_by_hand(out), text_of(out / "CHANGES.md")):
            path = folder / part.path
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("wb") as file:
                file.writelines(part.pieces)
            written.append(out / part.path)
    return written


def write_zip(file: IO[bytes], source: Source) -> None:
    """The dataset as a ZIP file with one folder in it; memory does not grow with the rows."""
    folder = name_of(source.study)
    moment = datetime.fromtimestamp(source.now, UTC).timetuple()[:6]
    with zipfile.ZipFile(file, "w") as archive:
        for part in parts(source):
            info = zipfile.ZipInfo(f"{folder}/{part.path}", moment)
            info.compress_type = zipfile.ZIP_STORED if part.path.endswith(".png") else zipfile.ZIP_DEFLATED
            with archive.open(info, "w", force_zip64=True) as entry:
                for piece in part.pieces:
                    entry.write(piece)


def parts(source: Source, added: Mapping[str, Any] | None = None, changes: str = "") -> Iterator[Part]:
    """The dataset's files. `added`: keys for the description besides ours; `changes`: CHANGES.md so far."""
    study = source.study
    figures = counted(source)
    manifest = json.loads((study.folder / "stimuli" / "manifest.json").read_text(encoding="utf-8"))
    about = {
        "@context": CONTEXT,
        "@type": "Dataset",
        "name": study.title,
        "description": description_of(study, figures),
        "schemaVersion": f"Psych-DS {VERSION}",
        "inLanguage": study.settings.survey.language,
        **figures.coverage,
        "variableMeasured": variables(study),
    }
    yield Part("dataset_description.json", [written_json({**(added or {}), **about})])
    yield Part("README.md", [readme_text(study, figures, {file_name(study, what): what for what in DATA}, manifest)])
    yield Part("CHANGES.md", [changes_text(figures, changes)])
    yield Part(".psychds-ignore", [IGNORED.encode()])
    for what, table in DATA.items():
        pieces = csv_text(list(columns(table, study)), with_row_ids(table, ROWS[table](source)))
        yield Part(f"data/{file_name(study, what)}", (piece.encode() for piece in pieces))
    rows = (row for what, table in DATA.items() for row in described(file_name(study, what), columns(table, study)))
    yield Part("documentation/codebook.csv", (piece.encode() for piece in csv_text(list(CODEBOOK), rows)))
    yield from materials(study, manifest)


def columns(table: str, study: BuiltStudy) -> dict[str, Column]:
    """The columns of a data file: the row's name first, then those of the exported table that may be published."""
    return {"row_id": ROW_ID} | {
        name: column for name, column in columns_of(table, study).items() if name not in CLIENT
    }


def with_row_ids(table: str, rows: Iterator[Row]) -> Iterator[Row]:
    """The table's rows, each with its name."""
    for row in rows:
        yield {"row_id": "-".join(str(row[name]) for name in ROW_IDS[table]), **row}


def variables(study: BuiltStudy) -> list[dict[str, Any]]:
    """`variableMeasured`: every column of every data file once, under the name that stands in the header."""
    found: dict[str, dict[str, Column]] = {}
    for what, table in DATA.items():
        for name, column in columns(table, study).items():
            found.setdefault(str(cell(name)), {})[what] = column
    return [variable(name, where) for name, where in found.items()]


def variable(name: str, where: Mapping[str, Column]) -> dict[str, Any]:
    """One column as a schema.org PropertyValue; `where`: in which files, if its words differ there."""
    said: dict[str, list[str]] = {}
    for what, column in where.items():
        said.setdefault(sentence(column), []).append(what)
    texts = [text if len(said) == 1 else f"In {' and '.join(files)}: {text}" for text, files in said.items()]
    first = next(iter(where.values()))
    facts = {
        "unitText": first.unit or None,
        "minValue": first.minimum,
        "maxValue": first.maximum,
        "valueReference": list(first.values) or None,
    }
    described = {"@type": "PropertyValue", "name": name, "description": " ".join(texts)}
    return described | {key: value for key, value in facts.items() if value is not None}


def sentence(column: Column) -> str:
    """Description, type and what an empty cell means, in words."""
    kind = "ISO 8601 UTC time" if column.type == "time" else column.type
    empty = f" Empty: {column.missing}." if column.missing else ""
    return f"{column.description.rstrip('.')} ({kind}).{empty}"


def materials(study: BuiltStudy, manifest: Mapping[str, Any]) -> Iterator[Part]:
    """The study: manifest, pictures and study.toml, without completion codes.

    A study.toml with codes in it is left out, as is one that is not the one that the pictures were built from.
    """
    survey = manifest["study"].get("survey", {})
    secret = [key for key in CODES if survey.get(key)]
    kept = {**manifest["study"], "survey": {key: value for key, value in survey.items() if key not in secret}}
    yield Part("materials/stimuli/manifest.json", [written_json({**manifest, "study": kept})])
    for file, path in {stimulus.facts["file"]: stimulus.path for stimulus in study.stimuli}.items():
        yield Part(f"materials/stimuli/{file}", [path.read_bytes()])
    words = study.folder / "study.toml"
    if not secret and words.is_file() and not study_changed(study):
        yield Part("materials/study.toml", [words.read_bytes()])


def file_name(study: BuiltStudy, what: str) -> str:
    """The name of a data file."""
    return f"study-{name_of(study)}_description-{what}_data.csv"


def name_of(study: BuiltStudy) -> str:
    """The title in letters and digits of ASCII, as file names of Psych-DS must be: DiscsInGrey."""
    plain = unicodedata.normalize("NFKD", study.title).encode("ascii", "ignore").decode()
    words = re.findall("[A-Za-z0-9]+", plain)
    return "".join(word[0].upper() + word[1:] for word in words)[:40] or "Study"


def added_by_hand(out: Path) -> dict[str, Any]:
    """What stands in the dataset's description that is there already."""
    try:
        found = json.loads(text_of(out / "dataset_description.json") or "{}")
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def text_of(path: Path) -> str:
    """The file's text; none if it is not there."""
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def written_json(data: Mapping[str, Any]) -> bytes:
    """`data` as a JSON file that people can read."""
    return (json.dumps(data, indent=2, ensure_ascii=False) + "\n").encode()
