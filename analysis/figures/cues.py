"""Mean ratings against image cues: small multiples, one panel a cue, the pictures themselves as points."""

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.offsetbox import AnnotationBbox, OffsetImage

from analysis.cue_findings import CueFindings, cue_name
from analysis.figures.style import COLOURS, FAINT, STYLE, THUMBNAIL, Drawing, drawn, thumbnail
from analysis.study import StudyInfo
from analysis.wording import sentence_case

ACROSS = 4
MOST_THUMBNAILS = 20  # more of them hide each other
SIDE = 19  # points


def cue_figure(study: StudyInfo, found: CueFindings, number: int) -> Drawing | None:
    """Every cue of one question; None where no cue is of use."""
    if not found.used:
        return None
    pictures = found.frame.groupby("picture").agg({"rating": "mean", **dict.fromkeys(found.used, "first")})
    down = -(-len(found.used) // ACROSS)
    across = min(ACROSS, len(found.used))
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(2.5 * across + 0.4, 2.5 * down), layout=ConstrainedLayoutEngine(h_pad=0.1, w_pad=0.06))
        grid = figure.subplots(down, across, sharey=True, squeeze=False)
        for place, axes in enumerate(grid.ravel()):
            if place < len(found.used):
                draw_cue(axes, study, pictures, found.used[place])
                axes.set_ylabel("mean rating" if place % across == 0 else "")
            else:
                axes.remove()
        shown = "The pictures stand at their values" if len(pictures) <= MOST_THUMBNAILS else "A dot is a picture"
        if any(study.picture(str(identity)).role == "control" for identity in pictures.index):
            shown += ", controls in a frame" if len(pictures) <= MOST_THUMBNAILS else ""
        caption = (
            f"{sentence_case(found.question)}: mean rating of every different picture against its image cues. {shown}; "
            "line: least squares through the means; r: their correlation. The axis is cut to the means."
        )
        return drawn(figure, f"figure-cues-{number}", caption)


def draw_cue(axes: Axes, study: StudyInfo, pictures: pd.DataFrame, cue: str) -> None:
    """Means against one cue, with the line through them."""
    x, y = pictures[cue].to_numpy(dtype=float), pictures["rating"].to_numpy(dtype=float)
    middle = x.mean()
    slope = float(((x - middle) * (y - y.mean())).sum() / ((x - middle) ** 2).sum())
    ends = np.array([x.min(), x.max()])
    axes.plot(ends, y.mean() + slope * (ends - middle), color=COLOURS[0], linewidth=1.4, zorder=1)
    axes.scatter(x, y, color=COLOURS[2], s=14, zorder=2)
    if len(x) <= MOST_THUMBNAILS:
        for identity, at_x, at_y in zip(pictures.index, x, y, strict=True):
            place_picture(axes, study, str(identity), (float(at_x), float(at_y)))
    axes.margins(0.16, 0.2)
    axes.set_xlabel(cue_name(cue))
    axes.grid(color="#eceef1", linewidth=0.8, zorder=0)
    axes.set_axisbelow(True)
    axes.xaxis.set_major_locator(mpl.ticker.MaxNLocator(4))
    axes.tick_params(length=0, labelsize=8)
    if np.ptp(y) > 0:
        axes.set_title(f"r = {np.corrcoef(x, y)[0, 1]:.2f}".replace("-", "−"), loc="right", fontsize=8, color=FAINT)


def place_picture(axes: Axes, study: StudyInfo, identity: str, at: tuple[float, float]) -> None:
    """The picture itself at its values; a control has a frame."""
    picture = study.picture(identity)
    if picture.file is None or not picture.file.is_file():
        return
    image = OffsetImage(np.asarray(thumbnail(picture.file)), zoom=SIDE / THUMBNAIL)
    axes.add_artist(AnnotationBbox(image, at, frameon=False, pad=0))
    if picture.role == "control":
        axes.scatter(*at, s=(SIDE + 4) ** 2, marker="s", color=COLOURS[2], linewidths=0, zorder=2.5)
