"""The rules of Psych-DS 1.5 for a dataset's folder, under the names that its own validator gives them.

Written from the schema's rules (github.com/psych-ds/psych-DS, schema_model/versions/1.5.1/rules: errors.yaml,
files/common/core.yaml, files/tabular_data/data.yaml) and from what psych-ds/psychds-validator does with them. Errors
and warnings alike, except for the recommended folders `analysis` and `results` and for what only people can say
(author, citation, license): those are not ours to invent.
"""

import csv
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

DATA_FILE = r"([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\.(csv|tsv)"
KEYWORDS = {"study", "site", "subject", "session", "task", "condition", "trial", "stimulus", "description"}
CONTEXTS = {
    f"{scheme}://{www}schema.org{end}" for scheme in ("http", "https") for www in ("", "www.") for end in ("", "/")
}
IGNORED_BY_DEFAULT = {
    "sourcedata",
    "code",
    "stimuli",
    "materials",
    "results",
    "products",
    "analysis",
    "documentation",
    "log",
}
DIRECTORIES = {
    "MISSING_DATA_DIRECTORY": "data",
    "MISSING_MATERIALS_DIRECTORY": "materials",
    "MISSING_DOCUMENTATION_DIRECTORY": "documentation",
}
FILES = {
    "MISSING_README_DOC": ("README.md", "README.txt"),
    "MISSING_CHANGES_DOC": ("CHANGES.md", "CHANGES.txt"),
    "MISSING_PSYCHDSIGNORE": (".psychds-ignore",),
}
THING = {"name", "description", "identifier", "url"}
SCHEMA_ORG = {
    "Dataset": THING
    | {
        "author",
        "citation",
        "funder",
        "inLanguage",
        "keywords",
        "license",
        "schemaVersion",
        "temporalCoverage",
        "variableMeasured",
    },
    "PropertyValue": THING | {"maxValue", "minValue", "propertyID", "unitCode", "unitText", "value", "valueReference"},
    "Person": THING | {"givenName", "familyName", "affiliation"},
}
"""The properties of schema.org (https://schema.org/Dataset and so on) that a dataset of ours, or our tests, may use."""


def broken_rules(folder: Path) -> list[str]:
    """The rules that the dataset in `folder` breaks, each once, in alphabetical order."""
    return sorted({*missing_parts(folder), *wrong_description(folder), *wrong_files(folder)})


def missing_parts(folder: Path) -> Iterator[str]:
    """Files and folders that have to be there."""
    yield from (rule for rule, name in DIRECTORIES.items() if not (folder / name).is_dir())
    yield from (rule for rule, names in FILES.items() if not any((folder / name).is_file() for name in names))
    if not (folder / "dataset_description.json").is_file():
        yield "MISSING_DATASET_DESCRIPTION"
    if not data_files(folder):
        yield "MISSING_DATAFILE"
    if any(path.parent != folder for path in folder.rglob("dataset_description.json")):
        yield "WRONG_METADATA_LOCATION"


def data_files(folder: Path) -> list[Path]:
    """The CSV files that the rules are about."""
    return sorted(path for path in folder.glob("data/**/*.csv") if "raw" not in path.relative_to(folder).parts)


def wrong_description(folder: Path) -> Iterator[str]:
    """What is wrong with dataset_description.json."""
    try:
        told = json.loads((folder / "dataset_description.json").read_bytes().decode())
    except FileNotFoundError:
        return
    except UnicodeDecodeError:
        yield "JSON_ENCODING_ERROR"
        return
    except ValueError:
        yield "INVALID_JSON_FORMATTING"
        return
    if told.get("@context") not in CONTEXTS:
        yield "INVALID_JSONLD_FORMATTING"
    if "@type" not in told:
        yield "MISSING_DATASET_TYPE"
    elif told["@type"] != "Dataset":
        yield "INCORRECT_DATASET_TYPE"
    if not {"name", "description", "variableMeasured"} <= set(told):
        yield "JSON_KEY_REQUIRED"
    yield from wrong_objects(told, told.get("@type", "Dataset"))


def wrong_objects(value: Any, kind: str) -> Iterator[str]:
    """Objects without a type, and properties that their type has not, in `value` and all that is in it."""
    for key, inner in value.items():
        if not key.startswith("@") and key not in SCHEMA_ORG.get(kind, set()):
            yield "INVALID_SCHEMAORG_PROPERTY"
        for item in inner if isinstance(inner, list) else [inner]:
            if isinstance(item, dict):
                if "@type" not in item:
                    yield "OBJECT_TYPE_MISSING"
                yield from wrong_objects(item, item.get("@type", ""))


def wrong_files(folder: Path) -> Iterator[str]:
    """What is wrong with names and contents of files, and between headers and `variableMeasured`."""
    headers: set[str] = set()
    for path in data_files(folder):
        if not re.fullmatch(DATA_FILE, path.name):
            yield "FILENAME_KEYWORD_FORMATTING_ERROR"
        elif not {part.split("-")[0] for part in path.name.split("_")[:-1]} <= KEYWORDS:
            yield "FILENAME_UNOFFICIAL_KEYWORD_WARNING"
        try:
            header, *rows = [*csv.reader(path.read_text(encoding="utf-8").splitlines(keepends=True), strict=True)] or [
                []
            ]
        except csv.Error:
            yield "CSV_FORMATTING_ERROR"
            continue
        headers.update(header)
        yield from wrong_table(header, rows)
    yield from wrong_variables(folder, headers)
    for path in folder.rglob("*"):
        first = path.relative_to(folder).parts[0]
        known = path.parent == folder and path.name in {
            "dataset_description.json",
            *(n for names in FILES.values() for n in names),
        }
        if path.is_file() and not path.stat().st_size:
            yield "FILE_EMPTY"
        if path.is_file() and not known and first not in IGNORED_BY_DEFAULT and path not in data_files(folder):
            yield "FILE_NOT_CHECKED"


def wrong_table(header: list[str], rows: list[list[str]]) -> Iterator[str]:
    """What is wrong with one table."""
    if not header:
        yield "CSV_HEADER_MISSING"
    if len(set(header)) < len(header):
        yield "CSV_HEADER_REPEATED"
    if any(len(row) != len(header) for row in rows):
        yield "CSV_HEADER_LENGTH_MISMATCH"
    elif "row_id" in header:
        names = [row[header.index("row_id")] for row in rows]
        if len(set(names)) < len(names):
            yield "ROWID_VALUES_NOT_UNIQUE"


def wrong_variables(folder: Path, headers: set[str]) -> Iterator[str]:
    """Columns and `variableMeasured` must be the same set."""
    try:
        told = json.loads((folder / "dataset_description.json").read_bytes())["variableMeasured"]
    except (OSError, ValueError, KeyError):
        return
    variables = {variable["name"] if isinstance(variable, dict) else variable for variable in told}
    if headers - variables:
        yield "CSV_COLUMN_MISSING_FROM_METADATA"
    if variables - headers:
        yield "VARIABLE_MISSING_FROM_CSV_COLUMNS"
