"""Plots of mean ratings like the thesis's figures 4.5 and 4.6: pictures on the axis, every answer in view."""

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.offsetbox import AnnotationBbox

from analysis.figures.grid import factor_grid, in_parts, label_scale
from analysis.figures.style import COLOURS, STYLE, Drawing, drawn, folded, place_thumbnail
from analysis.results import Analysed
from analysis.sentences import ordered_means
from analysis.study import Question, StudyInfo
from analysis.wording import percent, sentence_case

SIDE_BY_SIDE, PICTURED = 12, 8
"""Pictures compared in a panel, levels of a factor with thumbnails: more would overlap."""

DISCS = 60
"""Different answers above each other."""


def interval_name(mode: str, confidence: float) -> str:
    """The kind of interval, for captions."""
    kind = "within-subject (Cousineau–Morey)" if mode == "repeated" else "between-subject"
    return f"{percent(confidence)} {kind} confidence interval"


def factor_figures(study: StudyInfo, found: Sequence[Analysed], confidence: float) -> list[Drawing]:
    """Figure 4.5: a factor per row, a question per column; of more than three questions a figure for every three."""
    mine = [each for each in found if each.row.kind == "factor" and each.means is not None]
    return [factor_figure(study, part, confidence, suffix) for part, suffix in in_parts(mine)]


def factor_figure(study: StudyInfo, mine: Sequence[Analysed], confidence: float, suffix: str) -> Drawing:
    """Figure 4.5 of up to three questions."""

    def draw(axes: Axes, each: Analysed, row: int) -> None:
        """One panel, in its factor's colour."""
        draw_means(axes, each, study, COLOURS[row % len(COLOURS)])

    with mpl.rc_context(STYLE):
        figure = factor_grid(study, mine, draw, height=3.3, room=0.3)
        first = study.question(mine[0].row.question)
        caption = (
            f"Mean ratings by factor (rows) and question (columns). {answer_scale(first)}"
            f"Bars: {interval_name(mine[0].mode, confidence)}. {discs_named(mine)}"
        )
        return drawn(figure, f"figure-4-5-factors{suffix}", caption)


def comparison_figures(study: StudyInfo, found: Sequence[Analysed], confidence: float) -> list[Drawing]:
    """Figure 4.6: the compared pictures side by side, where they are twelve or fewer."""
    mine = [each for each in found if each.row.kind != "factor" and each.means is not None]
    few = [each for each in mine if len(each.row.levels) <= SIDE_BY_SIDE]
    return [comparison_figure(study, few, confidence)] if few else []


def comparison_figure(study: StudyInfo, mine: Sequence[Analysed], confidence: float) -> Drawing:
    """Figure 4.6 of up to twelve pictures."""
    with mpl.rc_context(STYLE):
        most = max(len(each.row.levels) for each in mine)
        width = max(4.2, 0.95 * most + 1.2)
        across = 1 if width > 6 else min(len(mine), 2 if width > 4.5 else 3)
        down = -(-len(mine) // across)
        figure = Figure(
            figsize=(min(width, 12) * across, 3.4 * down), layout=ConstrainedLayoutEngine(h_pad=0.12, w_pad=0.06)
        )
        grid = figure.subplots(down, across, squeeze=False).ravel()
        for axes, each in zip(grid, mine, strict=False):
            draw_means(axes, each, study, COLOURS[0], joined=False)
            axes.set_title(
                sentence_case(each.row.name if each.row.kind == "comparison" else each.row.question), fontweight="bold"
            )
            label_scale(axes, study.question(each.row.question), named=True)
        for axes in grid[len(mine) :]:
            axes.remove()
        caption = (
            f"Mean ratings of the pictures compared. {answer_scale(study.question(mine[0].row.question))}"
            f"Bars: {interval_name(mine[0].mode, confidence)}. {discs_named(mine)}"
        )
        return drawn(figure, "figure-4-6-comparison", caption)


def thinned(axes: Axes, labels: Sequence[str]) -> None:
    """Labels below the places 0, 1, ...; of many every so-manieth, so that they do not run into each other."""
    step = -(-sum(len(label) + 2 for label in labels) // 52)
    axes.set_xticks(range(0, len(labels), step), labels[::step])


def draw_means(axes: Axes, each: Analysed, study: StudyInfo, colour: str, joined: bool = True) -> None:
    """Means with intervals over the distribution of answers; below, the pictures and their levels."""
    table = ordered_means(each)
    places = np.arange(len(table))
    draw_answers(axes, each, list(table["level"]))
    half = (table["ci_high"] - table["mean"]).fillna(0.0)
    style = "-" if joined else "none"
    axes.errorbar(
        places, table["mean"], yerr=half, color=colour, marker="o", markersize=6, linestyle=style, linewidth=1.4,
        elinewidth=1.8, capsize=4, capthick=1.8, zorder=3,
    )  # fmt: skip
    axes.set_xlim(-0.6, len(table) - 0.4)
    by_code = {level.code: level for level in each.row.levels}
    labels = []
    for place, code in zip(places, table["level"], strict=True):
        level = by_code[str(code)]
        file = study.picture(level.stimuli[0]).file if len(level.stimuli) == 1 else None
        if file is not None and file.is_file() and (each.row.kind != "factor" or len(table) <= PICTURED):
            place_thumbnail(axes, float(place), file, 36 if each.row.kind != "factor" else min(36, 175 / len(table)))
        labels.append(level.printed if each.row.kind == "factor" else f"{level.code}\n{folded(level.printed)}")
    pad = 42 if any(isinstance(artist, AnnotationBbox) for artist in axes.artists) else 4
    if each.row.kind == "factor":
        thinned(axes, labels)
    else:
        axes.set_xticks(places, labels)
    axes.tick_params(axis="x", length=0, pad=pad)


def discs_named(mine: Sequence[Analysed]) -> str:
    """What the discs are, for captions."""
    classed = any(each.answers["rating"].nunique() > DISCS for each in mine)
    whose = "each person’s mean over the pictures of a level, in classes" if classed else "all answers"
    return f"Grey discs: {whose}, area by their share."


def draw_answers(axes: Axes, each: Analysed, codes: list[object]) -> None:
    """A faint disc for each answer that was given, area by how many gave it; persons' means over many pictures take
    too many values for that, and stand at the nearest of a grid."""
    answers = each.answers["rating"]
    if answers.nunique() > DISCS:
        step = np.ptp(answers) / DISCS
        answers = (answers / step).round() * step
    for place, code in enumerate(codes):
        given = answers[each.answers["condition"] == code].value_counts()
        share = given / given.sum()
        axes.scatter(
            np.full(len(share), place),
            share.index,
            s=800 * share,
            color="#d6dae0",
            linewidths=0,
            zorder=1,
            clip_on=False,
        )


def answer_scale(question: Question) -> str:
    """What the ends of the axis mean, for captions."""
    if question.scale is None:
        return ""
    named = question.low and question.high
    return f"1 {question.low}, {question.scale} {question.high}. " if named else f"Scale 1 to {question.scale}. "
