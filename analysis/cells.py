"""How many people were to rate each picture, did, and are analysed, question by question."""

import pandas as pd

from analysis.ratings import is_first_showing
from analysis.sample import Sample
from analysis.study import Picture, StudyInfo
from analysis.tables import Table
from analysis.wording import counted, level_text, true_minus

COUNTS = ("n_expected", "n_answered", "n_analysed", "n_missing")


def cell_table(sample: Sample, study: StudyInfo) -> pd.DataFrame:
    """A row per picture and question of the study, in the order of both.

    Columns: `question, stimulus, label, levels` ("light = 0.8, veil = thin"), `n_expected` (people
    who were to rate it: those with a line in the file, also where they left before it came), `n_answered`,
    `n_missing` (expected and not answered), `n_analysed` (answers used: those of people who are analysed).
    """
    shown = sample.of_everyone[is_first_showing(sample.of_everyone)]
    cells = [shown["question"], shown["stimulus"]]
    counts = pd.DataFrame(
        {"n_expected": shown.groupby(cells)["rating"].size(), "n_answered": shown.groupby(cells)["rating"].count()}
    )
    counts["n_analysed"] = sample.ratings.groupby(["question", "stimulus"]).size()
    counts["n_missing"] = counts["n_expected"] - counts["n_answered"]
    known = [study.picture(str(name)) for name in shown["stimulus"].unique()]
    listed = {picture.id: picture for picture in (*study.pictures, *known)}
    order = pd.MultiIndex.from_product(
        [[q.name for q in study.questions], list(listed)], names=["question", "stimulus"]
    )
    found = counts.reindex(order).fillna(0).astype(int).reset_index()
    pictures = [listed[name] for name in found["stimulus"]]
    found.insert(2, "label", [picture.label for picture in pictures])
    found.insert(3, "levels", [levels_text(picture) for picture in pictures])
    return found[["question", "stimulus", "label", "levels", *COUNTS]]


def levels_text(picture: Picture) -> str:
    """The levels of a picture in the rows it stands in."""
    return ", ".join(f"{name} = {level_text(value)}" for name, value in picture.levels if name in picture.rows)


def in_every_cell(cells: pd.DataFrame) -> str:
    """One sentence where all cells have the same counts; empty where they differ."""
    if any(cells[name].nunique() != 1 for name in COUNTS) or cells.empty:
        return ""
    first, questions = cells.iloc[0], cells["question"].nunique()
    each = "the question" if questions == 1 else f"each of {questions} questions"
    people = "people" if first["n_expected"] != 1 else "person"
    return (
        f"Each of {counted(len(cells) // questions, 'picture')} had {first['n_expected']} {people} to rate it, with "
        f"{counted(int(first['n_analysed']), 'answer')} analysed on {each}."
    )


def table_of_cells(cells: pd.DataFrame) -> Table:
    """Pictures down, questions across: answers analysed, and of how many where some are missing or left out."""
    questions = list(dict.fromkeys(cells["question"]))
    with_levels = bool((cells["levels"] != "").any())
    rows = []
    for name, part in cells.groupby("stimulus", sort=False):
        by_question = part.set_index("question")
        levels = (true_minus(str(part["levels"].iloc[0])),) if with_levels else ()
        rows.append((str(name), *levels, *(in_words(by_question.loc[question]) for question in questions)))
    legend = "Answers are fewer where people rated only some of the pictures."
    fewer = cells[cells["n_analysed"] < cells["n_expected"]]
    if len(fewer):
        used, asked = fewer.iloc[0][["n_analysed", "n_expected"]]
        legend = f'"{in_words(fewer.iloc[0])}": {used} answers are analysed of {asked} people who were to rate it.'
    return Table(
        "table-cells",
        "Answers analysed, by picture and question",
        ("Picture", *(("Levels",) if with_levels else ()), *questions),
        tuple(rows),
        text_columns=2 if with_levels else 1,
        note=f"{legend} Missing answers: tables/cells.csv.",
    )


def in_words(cell: "pd.Series[int]") -> str:
    """40 of 44."""
    if cell["n_expected"] == cell["n_analysed"]:
        return str(cell["n_analysed"])
    return f"{cell['n_analysed']} of {cell['n_expected']}"
