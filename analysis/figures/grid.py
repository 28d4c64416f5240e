"""Panels for factors and questions: a factor per row, a question per column."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from analysis.results import Analysed
from analysis.study import Question, StudyInfo
from analysis.wording import sentence_case

ACROSS = 3
"""Questions beside each other in a figure: more would be too small on a page."""

Draw = Callable[[Axes, Analysed, int], None]


def in_parts(mine: Sequence[Analysed]) -> Iterator[tuple[list[Analysed], str]]:
    """The rows of every three questions, and what ends the name of their figure: nothing, -2, -3, ..."""
    questions = list(dict.fromkeys(each.row.question for each in mine))
    for number, start in enumerate(range(0, len(questions), ACROSS), 1):
        part = questions[start : start + ACROSS]
        yield [each for each in mine if each.row.question in part], f"-{number}" if number > 1 else ""


def factor_grid(
    study: StudyInfo, mine: Sequence[Analysed], draw: Draw, *, height: float, room: float, what: str = "mean rating",
    pad: float | None = None,
) -> Figure:  # fmt: skip
    """A figure of `draw(axes, each, row)` for each of `mine`, rows by factor.

    `height`: inches of a row of panels; `room`: inches of the figure beside them; `what`: the axis of ratings; `pad`:
    points between panel and title.
    """
    factors = list(dict.fromkeys(each.row.name for each in mine))
    questions = list(dict.fromkeys(each.row.question for each in mine))
    figure = Figure(
        figsize=(panel_width(mine) * len(questions) + 0.5, height * len(factors) + room),
        layout=ConstrainedLayoutEngine(h_pad=0.12, w_pad=0.06),
    )
    grid = figure.subplots(len(factors), len(questions), sharey="row", squeeze=False)
    for axes in grid.ravel():
        axes.set_axis_off()
    for each in mine:
        row, column = factors.index(each.row.name), questions.index(each.row.question)
        axes = grid[row][column]
        axes.set_axis_on()
        draw(axes, each, row)
        axes.set_xlabel(each.row.name)
        if row == 0:
            axes.set_title(sentence_case(each.row.question), fontweight="bold", pad=pad)
        label_scale(axes, study.question(each.row.question), named=column == 0, what=what)
    return figure


def panel_width(mine: Sequence[Analysed]) -> float:
    """Inches of a panel: wider for more levels."""
    return float(np.clip(0.45 * max(len(each.row.levels) for each in mine), 3.1, 4.4))


def label_scale(axes: Axes, question: Question, named: bool, what: str = "mean rating") -> None:
    """The whole scale, its ends named once a row."""
    if question.scale is not None:
        axes.set_ylim(0.6, question.scale + 0.4)
    if question.scale is not None and question.scale <= 11:
        axes.set_yticks(range(1, question.scale + 1))
    axes.grid(axis="y", color="#eceef1", linewidth=0.8, zorder=0)
    axes.set_axisbelow(True)
    axes.tick_params(axis="y", length=0)
    if named:
        axes.set_ylabel(what)
