"""The means of many pictures from the lowest to the highest."""

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from analysis.figures.grid import label_scale
from analysis.figures.means import SIDE_BY_SIDE, answer_scale, interval_name
from analysis.figures.style import COLOURS, STYLE, Drawing, drawn, folded, place_thumbnail
from analysis.results import Analysed
from analysis.rows import Level
from analysis.study import StudyInfo
from analysis.wording import sentence_case

ALL_NAMED, ENDS_NAMED = 24, 3
"""Up to so many pictures each has its thumbnail; of more the first and the last three."""


def ranked_figures(study: StudyInfo, found: Sequence[Analysed], confidence: float) -> list[Drawing]:
    """A figure for each row of more pictures than stand side by side."""
    many = [each for each in found if each.row.kind != "factor" and each.means is not None]
    many = [each for each in many if len(each.row.levels) > SIDE_BY_SIDE]
    return [ranked_figure(study, each, confidence, number) for number, each in enumerate(many, 1)]


def ranked_figure(study: StudyInfo, each: Analysed, confidence: float, number: int) -> Drawing:
    """Means with intervals, and the pictures below."""
    assert each.means is not None
    table = each.means.sort_values("mean", kind="stable")
    total, question = len(table), study.question(each.row.question)
    by_code = {level.code: level for level in each.row.levels}
    levels = [by_code[str(code)] for code in table["level"]]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9.5, 3.6), layout=ConstrainedLayoutEngine(h_pad=0.12, w_pad=0.06))
        axes = figure.subplots()
        places, half = np.arange(total), (table["ci_high"] - table["mean"]).fillna(0.0)
        low, high = table["mean"] - half, table["mean"] + half
        axes.vlines(places, low, high, color="#9cc3e0", linewidth=min(2.0, 300 / total))
        axes.plot(places, table["mean"], "o", color=COLOURS[0], markersize=min(4.0, 600 / total))
        axes.set_xticks([])
        axes.set_xlim(-0.02 * total - 0.5, 1.02 * total - 0.5)
        name_below(axes, study, levels)
        axes.set_title(sentence_case(each.row.name if each.row.kind == "comparison" else question.name), weight="bold")
        label_scale(axes, question, named=True)
        named = "" if total <= ALL_NAMED else f", the {ENDS_NAMED} at either end named"
        caption = (
            f"Mean ratings of “{question.name}”: {total} pictures from the lowest mean to the highest{named}. "
            f"{answer_scale(question)}Bars: {interval_name(each.mode, confidence)}. "
            "Every mean stands in tables/means.csv."
        )
        return drawn(figure, f"figure-ranked-{number}", caption)


def name_below(axes: Axes, study: StudyInfo, levels: Sequence[Level]) -> None:
    """Thumbnails and labels of all pictures, or of both ends side by side."""
    total = len(levels)
    if total <= ALL_NAMED:
        named = [(float(place), level) for place, level in enumerate(levels)]
    else:
        apart = [(place + 0.5) * total / 14 for place in range(ENDS_NAMED)]  # a fourteenth of the axis: 0.6 inches
        named = list(zip(apart, levels[:ENDS_NAMED], strict=True))
        named += [
            (total - 1 - place, level) for place, level in zip(apart, levels[: -ENDS_NAMED - 1 : -1], strict=True)
        ]
    side = min(36.0, 560 / total) if total <= ALL_NAMED else 36.0
    for place, level in named:
        file = study.picture(level.stimuli[0]).file
        if file is not None and file.is_file():
            place_thumbnail(axes, place, file, side)
        axes.annotate(
            level.printed if total <= ALL_NAMED else folded(level.printed), (place, 0), (0, -side - 8),
            xycoords=("data", "axes fraction"), textcoords="offset points", ha="center", va="top", fontsize=7,
            rotation=90 if total <= ALL_NAMED else 0,
        )  # fmt: skip
