"""Forest plots of differences against the margin of equivalence, which is a band: inside it is alike."""

from collections.abc import Iterator, Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.offsetbox import AnnotationBbox, OffsetImage

from analysis.figures.style import COLOURS, FAINT, INK, STYLE, THUMBNAIL, Drawing, drawn, folded, thumbnail
from analysis.margins import Judged
from analysis.statistics.equivalence import UNTESTED
from analysis.study import StudyInfo
from analysis.wording import percent, sentence_case, steps

# colour and shape both tell the verdict: in grey print and to every eye
MARKS = {
    "equivalent": (COLOURS[0], "o"),
    "both": (COLOURS[1], "D"),
    "undecided": (FAINT, "o"),
    "different": (COLOURS[2], "s"),
}
BAND = "#dcebf7"
MOST_PAIRS = 36  # lines of one figure: more do not stand on a page
LINE, HEADING = 0.3, 0.42  # inches
LETTERS = 34  # of a line of names


def equivalence_figures(judged: Sequence[Judged], study: StudyInfo) -> tuple[Drawing, ...]:
    """A figure per question, rows below each other; a question of very many pairs takes several."""
    shown = [one for one in judged if one.shown]
    return tuple(forest(part, study, number) for number, part in enumerate(parts(shown), 1))


def parts(judged: Sequence[Judged]) -> Iterator[list[Judged]]:
    """Rows of one question, at most `MOST_PAIRS` pairs together (a row is never divided)."""
    for question in dict.fromkeys(one.each.row.question for one in judged):
        part: list[Judged] = []
        for one in (one for one in judged if one.each.row.question == question):
            if part and sum(len(other.pairs) for other in part) + len(one.pairs) > MOST_PAIRS:
                yield part
                part = []
            part.append(one)
        yield part


def forest(part: Sequence[Judged], study: StudyInfo, number: int) -> Drawing:
    """The rows of one question under each other, on one axis of differences."""
    heights = [len(one.pairs) * LINE + HEADING for one in part]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7.2, sum(heights) + 0.5), layout=ConstrainedLayoutEngine(h_pad=0.03, w_pad=0.06))
        grid = figure.subplots(len(part), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
        for axes, one in zip(grid, part, strict=True):
            draw_row(axes, one, study)
        limit = 1.08 * max(reach(one) for one in part)
        grid[-1].set_xlim(-limit, limit)
        question = study.question(part[0].each.row.question)
        grid[-1].set_xlabel(f"difference of ratings of “{question.name}” (band: margin of {steps(part[0].margin)})")
        level = 1 - 2 * part[0].alpha
        caption = (
            f"Are they rated alike? {sentence_case(question.name)}: differences with {percent(level)} confidence "
            f"intervals. Band: the margin of ±{part[0].margin:g} declared before the data. Equivalent (blue disc): "
            "the interval lies inside the band. Different (square): the two-sided test says so. Both (diamond): a "
            "difference smaller than matters. Undecided (open circle): too few answers to say either."
        )
        return drawn(figure, f"figure-equivalence-{number}", caption)


def reach(one: Judged) -> float:
    """The farthest that anything of a row lies from 0."""
    ends = one.pairs[["difference", "ci_low", "ci_high"]].abs().to_numpy()
    return max(one.margin, float(np.nanmax(ends)))


def draw_row(axes: Axes, one: Judged, study: StudyInfo) -> None:
    """A line per pair; the first on top."""
    axes.axvspan(-one.margin, one.margin, color=BAND, linewidth=0, zorder=0)
    for edge in (-one.margin, one.margin):
        axes.axvline(edge, color=COLOURS[0], linestyle=(0, (4, 3)), linewidth=0.9, zorder=1)
    axes.axvline(0, color=FAINT, linewidth=0.8, zorder=1)
    pictures = has_pictures(one, study)
    for place, pair in enumerate(one.records):
        colour, marker = MARKS.get(pair["verdict"], (FAINT, "x"))
        if pair["verdict"] != UNTESTED:
            axes.plot([pair["ci_low"], pair["ci_high"]], [place] * 2, color=colour, linewidth=2.4, zorder=2)
        filled = "white" if pair["verdict"] == "undecided" else colour
        axes.plot(pair["difference"], place, marker, color=colour, markerfacecolor=filled, markersize=6, zorder=3)
        axes.annotate(
            pair["verdict"], (1, place), (6, 0), xycoords=("axes fraction", "data"), textcoords="offset points",
            va="center", color=INK, fontsize=8, annotation_clip=False,
        )  # fmt: skip
        if pictures:
            place_pair(axes, place, [pair["a"], pair["b"]], one, study)
    axes.set_ylim(len(one.pairs) - 0.4, -0.6)
    axes.set_yticks(range(len(one.pairs)), [folded(one.named(pair), LETTERS) for pair in one.records])
    axes.tick_params(axis="y", length=0, pad=48 if pictures else 4)
    axes.tick_params(axis="x", length=0)
    axes.spines["left"].set_visible(False)
    axes.set_title(one.each.row.title, fontweight="bold", loc="left")


def has_pictures(one: Judged, study: StudyInfo) -> bool:
    """Whether every sample is one picture whose file is there."""
    files = [study.picture(level.stimuli[0]).file for level in one.each.row.levels if len(level.stimuli) == 1]
    return len(files) == len(one.each.row.levels) and all(file is not None and file.is_file() for file in files)


def place_pair(axes: Axes, place: int, codes: list[str], one: Judged, study: StudyInfo) -> None:
    """Both pictures beside the line, in the order of the subtraction."""
    stimuli = {level.code: level.stimuli[0] for level in one.each.row.levels}
    files = [study.picture(stimuli[code]).file for code in codes]
    boxes = [OffsetImage(np.asarray(thumbnail(file)), zoom=20 / THUMBNAIL) for file in files if file is not None]
    for box, shift in zip(boxes, (-26, -4), strict=True):
        axes.add_artist(
            AnnotationBbox(
                box, (0, place), (shift, 0), xycoords=("axes fraction", "data"), boxcoords="offset points",
                box_alignment=(1, 0.5), frameon=False, pad=0, annotation_clip=False,
            )
        )  # fmt: skip
