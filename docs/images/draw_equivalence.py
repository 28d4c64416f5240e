"""Draws the figures of docs/equivalence.md again: `python docs/images/draw_equivalence.py` (no OpenGL)."""

from math import sqrt
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure
from scipy import stats

from analysis.evidence import gather
from analysis.figures.equivalence import equivalence_figures
from analysis.figures.style import COLOURS, FAINT, STYLE, drawn
from analysis.levels import from_ratings
from analysis.margins import judge
from analysis.plan import AnalysisPlan, Comparison, EquivalencePlan
from analysis.ratings import read_ratings
from analysis.sample import draw_sample
from analysis.statistics.equivalence_power import equivalence_power, people_for_equivalence

HERE = Path(__file__).parent
RATINGS = HERE.parents[1] / "tests" / "data" / "statistics" / "thesis_shaped_repeated_n44.csv"
MARGIN, SD = 0.5, sqrt(2 * 2.19)


def verdicts() -> bytes:
    """The report's own figure of the thesis-shaped ratings."""
    compared = Comparison(
        name="offline images vs ours", question="translucent", stimuli=("img03", "img10", "img11", "img12")
    )
    plan = AnalysisPlan(comparison=(compared,), equivalence=EquivalencePlan(margin=MARGIN))
    ratings = read_ratings(RATINGS)
    study = from_ratings(ratings, "thesis-shaped", 7)
    evidence = gather(study, plan, draw_sample(ratings, plan), ratings)
    rows = [each for each in evidence.main if each.row.kind == "comparison"]
    assert plan.equivalence is not None
    return equivalence_figures(judge(rows, plan.equivalence)[0], study)[0].png


def people() -> bytes:
    """Half-width of the interval and power of the test against the number of people."""
    sizes = list(range(10, 251, 2))
    enough = people_for_equivalence(SD, MARGIN)
    curves = (
        ("half-width of the 90% interval, steps", [stats.t.ppf(0.95, n - 1) * SD / sqrt(n) for n in sizes], MARGIN),
        ("power of TOST, pictures exactly alike", [equivalence_power(n, SD, MARGIN) for n in sizes], 0.8),
    )
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7.2, 2.7), layout="constrained")
        for axes, (name, values, goal) in zip(figure.subplots(1, 2), curves, strict=True):
            axes.plot(sizes, values, color=COLOURS[0], linewidth=1.8)
            axes.axhline(goal, color=COLOURS[0], linestyle=(0, (4, 3)), linewidth=0.9)
            for n, words in ((44, "the thesis"), (enough, f"{enough} people")):
                axes.axvline(n, color=FAINT, linewidth=0.9)
                axes.annotate(words, (n, 0.66), (3, 0), xycoords=("data", "axes fraction"), textcoords="offset points",
                              va="top", fontsize=8)  # fmt: skip
            axes.set_title(name, loc="left")
            axes.set_xlabel("people")
            axes.set_ylim(0, 1)
            axes.set_xlim(0, 250)
        return drawn(figure, "equivalence-people", "").png


if __name__ == "__main__":
    (HERE / "equivalence.png").write_bytes(verdicts())
    (HERE / "equivalence-people.png").write_bytes(people())
