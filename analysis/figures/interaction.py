"""The interaction plot: cell means over one factor, a line for each level of another, a panel for those of a third."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.offsetbox import AnnotationBbox, OffsetImage

from analysis.figures.grid import ACROSS, label_scale
from analysis.figures.means import answer_scale, interval_name
from analysis.figures.style import COLOURS, STYLE, THUMBNAIL, Drawing, drawn, thumbnail
from analysis.results import Analysed
from analysis.rows import Level
from analysis.study import Factor, StudyInfo
from analysis.wording import joined, level_text, sentence_case, true_minus

MARKERS, DASHES = ("o", "s", "^", "D", "v", "P"), ("-", (0, (5, 2)), (0, (1, 1.2)), "-.", (0, (7, 2, 1, 2, 1, 2)), "-")
APART = tuple(COLOURS[place] for place in (0, 2, 1, 3, 5, 4))
"""The colours, those that differ most in grey first."""
SIDE = 22
"""Points: a thumbnail of a cell."""
PICTURED = (6, 4)
"""Levels on the axis and lines up to which cells have their thumbnails under the axis."""


@dataclass(frozen=True)
class Layout:
    """Which factor is on the axis (the one with the most levels), which makes lines, which make rows of panels."""

    axis: Factor
    lines: Factor
    panels: tuple[Factor, ...]

    def cell(self, each: Analysed, **held: Any) -> Level:
        """The sample at these levels, by role: `axis`, `lines` and `panels` (values in the order of the factors)."""
        wanted = {self.axis.name: held["axis"], self.lines.name: held["lines"]}
        wanted |= dict(zip((factor.name for factor in self.panels), held["panels"], strict=True))
        values = tuple(wanted[name] for name in each.row.factors)
        return next(level for level in each.row.levels if level.value == values)


def layout_of(factors: Sequence[Factor]) -> Layout:
    """Most levels on the axis, next most as lines; of equals the first declared."""
    axis, lines, *panels = sorted(factors, key=lambda factor: -len(factor.levels))
    return Layout(axis, lines, tuple(panels))


def interaction_figures(study: StudyInfo, found: Sequence[Analysed], confidence: float) -> list[Drawing]:
    """The whole factorial of each question; of more than three questions a figure for every three."""
    whole = [each for each in found if each.row.crossed and each.row.factors == each.row.crossed.names and each.anova]
    parts = [whole[i : i + ACROSS] for i in range(0, len(whole), ACROSS)]
    return [interaction_figure(study, part, confidence, f"-{i}" if i > 1 else "") for i, part in enumerate(parts, 1)]


def interaction_figure(study: StudyInfo, whole: Sequence[Analysed], confidence: float, suffix: str) -> Drawing:
    """A column of panels for each question, a row for each combination of third and further factors."""
    assert whole[0].row.crossed is not None
    layout = layout_of(whole[0].row.crossed.factors)
    combinations = list(product(*(factor.levels for factor in layout.panels)))
    with mpl.rc_context(STYLE):
        width = max(3.1, 0.62 * len(layout.axis.levels) + 1.2)
        figure = Figure(
            figsize=(width * len(whole) + 1.1, (2.7 + room(whole[0], layout, study) / 72) * len(combinations) + 0.3),
            layout=ConstrainedLayoutEngine(h_pad=0.12, w_pad=0.06),
        )
        grid = figure.subplots(len(combinations), len(whole), sharey="col", squeeze=False)
        for (row, values), (column, each) in product(enumerate(combinations), enumerate(whole)):
            axes = grid[row][column]
            draw_lines(axes, each, layout, values, study)
            at = ", ".join(f"{f.name} {true_minus(level_text(v))}" for f, v in zip(layout.panels, values, strict=True))
            heading = [sentence_case(each.row.question)] if row == 0 else []
            axes.set_title("\n".join([*heading, *([at] if at else [])]), fontweight="bold" if row == 0 else "normal")
            axes.set_xlabel(layout.axis.name)
            label_scale(axes, study.question(each.row.question), named=column == 0)
        grid[0][-1].legend(title=layout.lines.name, loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
        return drawn(figure, f"figure-interaction{suffix}", caption(study, whole, layout, confidence))


def caption(study: StudyInfo, whole: Sequence[Analysed], layout: Layout, confidence: float) -> str:
    """What is drawn, in words."""
    rows = f", a row of panels for each level of {joined([f.name for f in layout.panels])}" if layout.panels else ""
    return (
        f"Mean ratings of each combination: {layout.axis.name} on the axis, a line for each level of "
        f"{layout.lines.name}{rows}. {answer_scale(study.question(whole[0].row.question))}"
        f"Bars: {interval_name(whole[0].mode, confidence)}. Parallel lines: no interaction."
    )


def draw_lines(axes: Axes, each: Analysed, layout: Layout, values: tuple[Any, ...], study: StudyInfo) -> None:
    """A line with intervals for each level of the second factor, beside each other so that no bar hides another."""
    assert each.means is not None
    means = each.means.set_index("level")
    places, count = np.arange(len(layout.axis.levels)), len(layout.lines.levels)
    below = room(each, layout, study)
    for line, level in enumerate(layout.lines.levels):
        cells = [layout.cell(each, axis=value, lines=level, panels=values) for value in layout.axis.levels]
        own = means.loc[[cell.code for cell in cells]]
        colour, marker = APART[line % len(APART)], MARKERS[line % len(MARKERS)]
        axes.errorbar(
            places + 0.1 * (line - (count - 1) / 2), own["mean"], yerr=(own["ci_high"] - own["mean"]).fillna(0.0),
            color=colour, marker=marker, markersize=6, linestyle=DASHES[line % len(DASHES)], linewidth=1.4,
            elinewidth=1.4, capsize=3, label=true_minus(level_text(level)), zorder=3,
        )  # fmt: skip
        for place, cell in zip(places, cells, strict=True) if below else ():
            under(axes, float(place), line, cell, study, colour)
    axes.set_xlim(-0.5, len(places) - 0.5)
    axes.set_xticks(places, [true_minus(level_text(value)) for value in layout.axis.levels])
    axes.tick_params(axis="x", length=0, pad=4 + below)


def file_of(cell: Level, study: StudyInfo) -> Any:
    """The file of a cell that one picture shows."""
    file = study.picture(cell.stimuli[0]).file if len(cell.stimuli) == 1 else None
    return file if file is not None and file.is_file() else None


def room(each: Analysed, layout: Layout, study: StudyInfo) -> int:
    """Points under the axis for the cells' thumbnails; 0 where they are too many, or there are none."""
    few = len(layout.axis.levels) <= PICTURED[0] and len(layout.lines.levels) <= PICTURED[1]
    pictured = few and any(file_of(cell, study) is not None for cell in each.row.levels)
    return len(layout.lines.levels) * (SIDE + 3) if pictured else 0


def under(axes: Axes, place: float, line: int, cell: Level, study: StudyInfo, colour: str) -> None:
    """The cell's picture under its place on the axis, in the row of its line and framed in its colour."""
    file = file_of(cell, study)
    if file is None:
        return
    box = OffsetImage(np.asarray(thumbnail(file)), zoom=SIDE / THUMBNAIL)
    offset = (0, -4 - line * (SIDE + 3))
    frame = {"edgecolor": colour, "linewidth": 1.2, "boxstyle": "square,pad=0"}
    axes.add_artist(
        AnnotationBbox(
            box, (place, 0), xybox=offset, xycoords=("data", "axes fraction"), boxcoords="offset points",
            box_alignment=(0.5, 1), pad=0, bboxprops=frame, annotation_clip=False,
        )
    )  # fmt: skip
