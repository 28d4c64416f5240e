"""Diverging stacked bars of all answers, picture by picture (Heiberger & Robbins 2014): the middle of the scale stands
at 0, so that what leans to the right is what people agree with."""

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Patch
from numpy.typing import NDArray

from analysis.figures.style import INK, STYLE, Drawing, drawn, folded, place_thumbnail
from analysis.study import Picture, Question, StudyInfo
from analysis.wording import sentence_case, true_minus

ACROSS, DOWN, DRAWN = 3, 20, 60  # questions beside each other, pictures in a figure, pictures drawn at all
FINE = 11  # a scale with more steps is drawn in fifths
# orange to blue over grey: told apart with every kind of colour vision; in grey the side tells
LEANING = LinearSegmentedColormap.from_list(
    "leaning", ["#a04100", "#e08a3c", "#f8d3a8", "#e3e5e8", "#c3dcef", "#5b9fd0", "#0b4f8a"]
)
LABELLED = 0.095
"""A share below this is too narrow for its number."""


@dataclass(frozen=True)
class Steps:
    """The scale in the pieces that are told apart: names, colours, and which piece each answer falls into."""

    names: tuple[str, ...]
    piece: NDArray[np.int64]

    @property
    def colours(self) -> list[tuple[float, float, float, float]]:
        """From the one end to the other."""
        return [tuple(colour) for colour in LEANING(np.linspace(0, 1, len(self.names)))]


def steps_of(scale: int) -> Steps:
    """Every answer its own piece; of a fine scale five pieces as equal as whole numbers allow."""
    if scale <= FINE:
        return Steps(tuple(map(str, range(1, scale + 1))), np.arange(scale))
    piece = np.arange(scale) * 5 // scale
    ends = [(int(np.flatnonzero(piece == i)[0]) + 1, int(np.flatnonzero(piece == i)[-1]) + 1) for i in range(5)]
    return Steps(tuple(f"{low}–{high}" for low, high in ends), piece)


def stacked_figures(study: StudyInfo, shares: pd.DataFrame) -> list[Drawing]:
    """A figure for up to three questions of one scale and twenty pictures; none where there are more than 60.

    `shares`: `question, stimulus, answer, n, share` (statistics.shares).
    """
    rated = set(shares["stimulus"])
    shown = [p for p in study.pictures if p.id in rated]
    asked = [q for q in study.questions if q.scale is not None and q.name in set(shares["question"])]
    alike: dict[tuple[int | None, str, str], list[Question]] = {}
    for question in asked:
        alike.setdefault((question.scale, question.low, question.high), []).append(question)
    parts = [
        (same[i : i + ACROSS], shown[j : j + DOWN])
        for same in alike.values()
        for i in range(0, len(same), ACROSS)
        for j in range(0, len(shown), DOWN)
        if len(shown) <= DRAWN
    ]
    return [
        stacked_figure(pictures, questions, shares, f"figure-answers{f'-{number}' if len(parts) > 1 else ''}")
        for number, (questions, pictures) in enumerate(parts, 1)
    ]


def stacked_figure(pictures: Sequence[Picture], asked: Sequence[Question], shares: pd.DataFrame, stem: str) -> Drawing:
    """A panel for each question, a bar for each picture."""
    steps = steps_of(asked[0].scale or 0)
    height = 0.46 * len(pictures)
    with mpl.rc_context(STYLE):
        figure = Figure(
            figsize=(2.75 * len(asked) + 2.2, height + 1.15), layout=ConstrainedLayoutEngine(w_pad=0.06, h_pad=0.06)
        )
        panels = figure.subplots(1, len(asked), sharex=True, sharey=True, squeeze=False)[0]
        reach = 0.0
        for axes, question in zip(panels, asked, strict=True):
            table = by_picture(shares[shares["question"] == question.name], pictures, steps)
            reach = max(reach, draw_bars(axes, table, steps))
            axes.set_title(sentence_case(question.name), fontweight="bold")
        for axes in panels:
            dress(axes, reach)
        name_pictures(panels[0], pictures)
        figure.legend(
            handles=[Patch(facecolor=colour) for colour in steps.colours], labels=legend_names(asked[0], steps),
            loc="outside lower center", ncols=len(steps.names), frameon=False, handlelength=1.1, columnspacing=1.1,
            handletextpad=0.4,
        )  # fmt: skip
        return drawn(figure, stem, caption_of(shares, pictures, steps))


def by_picture(mine: pd.DataFrame, pictures: Sequence[Picture], steps: Steps) -> NDArray[np.float64]:
    """(pictures, pieces) shares, 0..1; NaN for a picture without answers."""
    table = mine.pivot(index="stimulus", columns="answer", values="share").reindex([p.id for p in pictures])
    values = table.to_numpy(dtype=np.float64)
    return np.stack([values[:, steps.piece == i].sum(axis=1) for i in range(len(steps.names))], axis=1)


def draw_bars(axes: Axes, table: NDArray[np.float64], steps: Steps) -> float:
    """The bars about the middle of the scale; how far the longest reaches, as a share."""
    start = -table[:, : len(steps.names) // 2].sum(axis=1)
    if len(steps.names) % 2:
        start = start - table[:, len(steps.names) // 2] / 2
    left = start
    for i, colour in enumerate(steps.colours):
        axes.barh(
            np.arange(len(table)), table[:, i], left=left, color=colour, height=0.74, edgecolor="white", linewidth=0.6
        )
        dark = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2] < 0.45
        for row in np.flatnonzero(table[:, i] >= LABELLED).tolist():
            place = left[row] + table[row, i] / 2
            axes.text(
                place,
                row,
                f"{100 * table[row, i]:.0f}",
                ha="center",
                va="center",
                fontsize=7,
                color="white" if dark else INK,
            )
        left = left + table[:, i]
    return float(np.nanmax(np.abs([start, left])))


def dress(axes: Axes, reach: float) -> None:
    """Zero in the middle, shares on either side without a sign."""
    axes.set_xlim(-1.04 * reach, 1.04 * reach)
    ends = np.arange(0, reach + 0.01, 0.5 if reach > 0.5 else 0.25)
    ticks = np.unique(np.concatenate([-ends, ends]))
    axes.set_xticks(ticks, [f"{100 * abs(tick):.0f}%" for tick in ticks])
    axes.axvline(0, color=INK, linewidth=0.8, zorder=0)
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", labelsize=7.5)


def name_pictures(axes: Axes, pictures: Sequence[Picture]) -> None:
    """Thumbnail and label at each row, the first on top."""
    axes.set_ylim(len(pictures) - 0.5, -0.5)
    placed = False
    for row, picture in enumerate(pictures):
        if picture.file is not None and picture.file.is_file():
            place_thumbnail(axes, row, picture.file, side=27, beside=True)
            placed = True
    axes.set_yticks(range(len(pictures)), [folded(true_minus(picture.label), 22) for picture in pictures])
    axes.tick_params(axis="y", pad=36 if placed else 4)


def legend_names(question: Question, steps: Steps) -> list[str]:
    """The steps' names, with the words at the scale's ends."""
    first, *middle, last = steps.names
    return [f"{first} {question.low}".strip(), *middle, f"{last} {question.high}".strip()]


def caption_of(shares: pd.DataFrame, pictures: Sequence[Picture], steps: Steps) -> str:
    """What a bar is, and of how many answers."""
    mine = shares[shares["stimulus"].isin([p.id for p in pictures])]
    n = mine.groupby(["question", "stimulus"])["n"].sum()
    many = f"{n.min()}" if n.min() == n.max() else f"{n.min()} to {n.max()}"
    middle = (
        f"{steps.names[len(steps.names) // 2]} is centred on"
        if len(steps.names) % 2
        else "the halves of the scale meet at"
    )
    return (
        f"All answers, picture by picture: {many} to each question, in per cent; {middle} the line, higher answers "
        f"lie to the right of it. Shares below {LABELLED:.0%} are drawn without their number."
    )
