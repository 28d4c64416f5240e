"""docs/tables.md names every table that a report writes, with every column of it."""

import re
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from analysis.evidence import gather
from analysis.page import sections_of
from analysis.plan import AnalysisPlan, EquivalencePlan, PlannedContrast
from analysis.ratings import read_ratings
from analysis.sample import draw_sample
from analysis.study import Factor, Picture, Question, StudyInfo

PAGE = (Path(__file__).parents[2] / "docs" / "tables.md").read_text(encoding="utf-8")
PLAN = AnalysisPlan(
    equivalence=EquivalencePlan(margin=1.0),
    contrast=(PlannedContrast(name="ends", question="shiny", weights={"s0": -1.0, "s4": 1.0}),),
)


def documented() -> dict[str, set[str]]:
    """Table -> the columns that its row and the list of common columns name."""
    common = {name for row in section("## Columns") for name in re.findall(r"`(\w+)`", row.split("|")[1])}
    return {row.split("`")[1]: common | set(re.findall(r"`(\w+)`", row)) for row in section("## The tables")}


def section(heading: str) -> list[str]:
    """The rows of the first table under a heading."""
    return [line for line in PAGE.split(heading)[1].split("\n## ")[0].splitlines() if line.startswith("| `")]


def study() -> StudyInfo:
    """3 x 2 pictures with cues, one of them repeated, one made elsewhere."""
    levels = list(product((1, 2, 3), (0, 1)))
    own = tuple(
        Picture(
            f"s{i}",
            f"s{i}",
            "factor",
            (("a", a), ("b", b)),
            ("a", "b"),
            cues=(("contrast", a + b / 7), ("skew", b * a)),
        )
        for i, (a, b) in enumerate(levels)
    )
    others = (Picture("twin", "twin", "repeat", same_picture_as="s0"), Picture("x", "x", "compare"))
    factors = (Factor("a", (1, 2, 3)), Factor("b", (0, 1)))
    return StudyInfo("t", "full-factorial", factors, (Question("shiny"),), (*own, *others), PLAN)


def tables(folder: Path, people: int, every: bool) -> Iterator[tuple[str, pd.DataFrame]]:
    """What a report of invented ratings would write: of everyone to every picture, or of other people to each."""
    noise = np.random.default_rng(3)
    known = study()
    rows = [
        (
            f"p{who}-{'' if every else number}",
            picture.id,
            "shiny",
            1 + (number + noise.integers(4)) % 7,
            number + 1,
            900,
        )
        for who in range(people)
        for number, picture in enumerate(known.pictures)
    ]
    path = folder / "ratings.csv"
    columns = ["participant", "stimulus", "question", "rating", "trial", "rt_ms"]
    pd.DataFrame(rows, columns=columns).to_csv(path, index=False)
    read = read_ratings(path)
    evidence = gather(known, known.plan, draw_sample(read, known.plan), read)
    for made in sections_of(evidence):
        yield from made.tables.items()


def test_every_table_and_column_stands_in_the_docs(tmp_path: Path) -> None:
    """Within people and between them; and the page names no table that neither has."""
    known, written = documented(), set()
    for name, table in (*tables(tmp_path, 12, every=True), *tables(tmp_path, 6, every=False)):
        written.add(name)
        assert name in known, f"tables/{name}.csv"
        measured = {"contrast", "skew"} if name == "cues" else set()
        assert set(map(str, table.columns)) - measured <= known[name], name
    assert written == set(known)
