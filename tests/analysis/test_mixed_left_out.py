"""Mixed models that these ratings do not have: no number out of rounding, no warning about a design, plain words."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hard_ratings import CASES, HEAD, ratings, scattered

from analysis import write_report
from analysis.statistics.mixed import MixedModel
from analysis.statistics.undefined import Undefined

Write = Callable[[str], Path]


def mixed_of(folder: Path) -> list[dict[str, object]]:
    """The table of mixed models in results.json."""
    return list(json.loads((folder / "results.json").read_text()).get("mixed", []))


@pytest.mark.parametrize("name", ["each picture constant, repeated", "zero residual", "all ratings equal"])
def test_no_statistic_out_of_rounding(csv_of: Write, tmp_path: Path, name: str) -> None:
    """Without a residual there is no chi-squared, and no p of 2e-308."""
    case = next(case for case in CASES if case.name == name)
    write_report(csv_of(case.text), tmp_path / "out")
    table = mixed_of(tmp_path / "out")
    assert table and all(row["reason"] and row.get("chi2") is None for row in table)


@pytest.mark.parametrize("unit", [1.0, 0.1, 1e9])
def test_a_residual_at_the_level_of_rounding(unit: float) -> None:
    """Pictures constant but for the last bit of a decimal: the same sentence."""
    frame = pd.DataFrame(
        [(f"p{who}", f"i{what}", "ab"[what % 2], unit * (3 + what % 2) + who * 1e-16 * unit)
         for who in range(8) for what in range(4)],
        columns=["person", "picture", "light", "rating"],
    )  # fmt: skip
    with pytest.raises(Undefined, match="leave no residual"):
        MixedModel("rating", ("light",), "person", "picture").fit(frame)


def test_a_small_residual_is_one() -> None:
    """A thousandth of the effect is still measured."""
    noise = np.random.default_rng(5).normal(size=40)
    frame = pd.DataFrame(
        [(f"p{who}", f"i{what}", "ab"[what % 2], what % 2 + 1e-3 * noise[4 * who + what]) for who in range(10)
         for what in range(4)],
        columns=["person", "picture", "light", "rating"],
    )  # fmt: skip
    assert MixedModel("rating", ("light",), "person", "picture").fit(frame).tests["chi2"].iloc[0] > 1e4


INDEPENDENT = HEAD + "".join(f"p{who},{'abc'[who % 3]},shiny,{scattered(who, who % 3)}\n" for who in range(30))


def test_independent_samples_of_single_pictures_need_no_warning(csv_of: Write, tmp_path: Path) -> None:
    """Nothing is wrong: one rating a person and one picture a level is the design. The table keeps the reason."""
    results = write_report(csv_of(INDEPENDENT), tmp_path / "out")
    assert not [sentence for sentence in results["warnings"] if "Mixed model" in sentence]
    (row,) = mixed_of(tmp_path / "out")
    assert str(row["reason"]).startswith("every cell is one picture, so the variance of pictures cannot be told")


@pytest.mark.parametrize("text", [INDEPENDENT, ratings()])
def test_no_name_of_ours_is_shown(csv_of: Write, tmp_path: Path, text: str) -> None:
    """The column is called picture' where picture is the factor; a reader meets pictures."""
    write_report(csv_of(text), tmp_path / "out")
    for path in [*(tmp_path / "out" / "tables").glob("*.csv"), tmp_path / "out" / "results.json"]:
        assert not [word for word in ("picture'", "participant'", "rating'") if word in path.read_text()], path.name


def test_one_participant_is_called_one(csv_of: Write, tmp_path: Path) -> None:
    """Who rated three pictures has given two ratings."""
    results = write_report(csv_of(ratings(people=1)), tmp_path / "out")
    text = " ".join(results["warnings"])
    assert "gave two ratings" not in text
    assert "there is one participant, so participants have no variance" in text
