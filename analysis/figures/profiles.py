"""Every person's line over a factor's levels, the mean on top: who goes with the trend, and who against it."""

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from analysis.figures.grid import factor_grid, in_parts
from analysis.figures.means import thinned
from analysis.figures.style import STYLE, Drawing, drawn
from analysis.results import Analysed
from analysis.sentences import ordered_means
from analysis.study import StudyInfo

LINES = 120
"""More lines in a panel hide each other: of more people every so-manieth is drawn."""
APART = 0.025
"""Of the span of the answers: equal ones would hide each other."""
WITH, AGAINST = "#6d7480", "#b84c00"


def profile_figures(study: StudyInfo, found: Sequence[Analysed]) -> list[Drawing]:
    """A factor per row, a question per column, up to three questions in a figure; none between different people."""
    return [profile_figure(study, part, f"figure-people{suffix}") for part, suffix in in_parts(drawable(found))]


def profile_figure(study: StudyInfo, mine: Sequence[Analysed], stem: str) -> Drawing:
    """All panels of some questions."""

    def draw(axes: Axes, each: Analysed, _: int) -> None:
        """One panel."""
        draw_people(axes, each)

    with mpl.rc_context(STYLE):
        figure = factor_grid(study, mine, draw, height=2.55, room=0.5, what="rating", pad=16)
        figure.legend(
            handles=[
                Line2D([], [], color=WITH, linewidth=1),
                Line2D([], [], color=AGAINST, linewidth=1, linestyle=(0, (4, 2))),
                Line2D([], [], color="black", linewidth=2.2, marker="o", markersize=4.5),
            ],
            labels=["a person, with the trend or level", "a person, against it", "mean"],
            loc="outside lower center", ncols=3, frameon=False,
        )  # fmt: skip
        return drawn(figure, stem, caption_of(mine))


def draw_people(axes: Axes, each: Analysed) -> None:
    """The lines of people and the mean, over the levels in their order."""
    table = ordered_means(each)
    values = by_person(each, [str(code) for code in table["level"]])
    against = along_trend(values) < 0
    some = np.arange(0, len(values), -(-len(values) // LINES))
    apart = APART * (np.nanmax(values) - np.nanmin(values))
    moved = values[some] + np.linspace(-apart, apart, len(some))[:, None]
    places = np.arange(values.shape[1])
    for side, colour, style in ((~against[some], WITH, "solid"), (against[some], AGAINST, (0, (4, 2)))):
        lines = [np.column_stack([places, line]) for line in moved[side]]
        axes.add_collection(
            LineCollection(lines, colors=colour, linewidths=0.8, linestyles=[style], alpha=0.45, zorder=2)
        )
    axes.plot(places, table["mean"], color="black", linewidth=2.2, marker="o", markersize=4.5, zorder=4)
    axes.set_xlim(-0.3, len(places) - 0.7)
    thinned(axes, [str(label) for label in table["label"]])
    axes.text(
        1, 1.01, f"{against.sum()} of {len(values)} against", transform=axes.transAxes, ha="right", va="bottom",
        fontsize=8, color=AGAINST,
    )  # fmt: skip


def by_person(each: Analysed, codes: Sequence[str]) -> NDArray[np.float64]:
    """(people, levels) ratings in the order of `codes`; NaN where a person did not rate a level."""
    table = each.answers.pivot(index="participant", columns="condition", values="rating").reindex(columns=list(codes))
    return table.to_numpy(dtype=np.float64)


def along_trend(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each person's rating of the level with the highest mean less that of the level with the lowest, (people,).

    `values`: (people, levels); the means are of those who rated every level, and others' differences are NaN.
    """
    complete = ~np.isnan(values).any(axis=1)
    if not complete.any():
        return np.full(len(values), np.nan)
    means = values[complete].mean(axis=0)
    return np.where(complete, values[:, int(means.argmax())] - values[:, int(means.argmin())], np.nan)


def trend_table(found: Sequence[Analysed]) -> pd.DataFrame:
    """How many people go with the trend, are level, or go against it: a row for each question and factor."""
    entries = []
    for each in drawable(found):
        difference = along_trend(by_person(each, [level.code for level in each.row.levels]))
        counts = {"with": difference > 0, "level": difference == 0, "against": difference < 0}
        entries.append(
            {
                "question": each.row.question,
                "factor": each.row.name,
                "n": int(np.isfinite(difference).sum()),
                **{name: int(people.sum()) for name, people in counts.items()},
            }
        )
    return pd.DataFrame(entries)


def drawable(found: Sequence[Analysed]) -> list[Analysed]:
    """Rows by factor in which the same people rated every level."""
    return [each for each in found if each.row.kind == "factor" and each.mode == "repeated" and each.means is not None]


def caption_of(mine: Sequence[Analysed]) -> str:
    """What a line is, and how many are drawn."""
    n = max(each.answers["participant"].nunique() for each in mine)
    drawn_people = len(range(0, n, -(-n // LINES)))
    some = f" Lines of {drawn_people} of {n} people, taken at equal steps of the list." if drawn_people < n else ""
    return (
        "Each person’s ratings over the levels of a factor (rows), question by question (columns). Against the trend: "
        "the level with the lowest mean is rated above the level with the highest. Lines are moved "
        f"apart a little: equal answers would hide each other.{some}"
    )
