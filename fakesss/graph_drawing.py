"""The frame graph of a scene as a picture: what is kept in solid lines, what is culled dashed and grey."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch, PathPatch, Polygon
from matplotlib.path import Path as Curve

from fakesss.frame_graph import Node, Plan
from fakesss.graph_layout import WIDTH, Joint, Layout, Line, layout
from fakesss.output import check_output, replacing

SUFFIXES = (".svg", ".pdf", ".png")
HEIGHT, ROW, MARGIN = 34.0, 84.0, 28.0  # of a box, from layer to layer, around the drawing
POINTS = 72.0  # of an inch, the unit of all lengths here
DPI = 110
DASHED = (0, (4, 3))
INK, GREY, PAPER = "#22262b", "#9aa0a6", "#ffffff"
COLOURS = {"Pass": ("#dfeaf8", "#2f5d95"), "Bake": ("#fbead2", "#9a6212"), "Choice": ("#e4f0df", "#4a7f3c")}
KEY = (
    ("Pass", *COLOURS["Pass"], "solid", "drawn"),
    ("Bake", *COLOURS["Bake"], "solid", "made on the processor"),
    ("Choice", *COLOURS["Choice"], "solid", "one of several"),
    ("Pass", PAPER, GREY, DASHED, "culled"),
)
SMALL, NORMAL = 7.5, 9.5  # type


def draw_graph(graph: Plan, path: str | Path, gpu_ms: Mapping[str, float | None] | None = None) -> None:
    """Write a compiled graph to a .svg, .pdf or .png file; `gpu_ms` adds each pass's time. Raises `BadInput`."""
    path = check_drawing(path)
    undated = {"Date": None} if path.suffix.lower() == ".svg" else {}
    kind = path.suffix[1:].lower()
    with replacing(path) as waiting, matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "fakesss"}):
        # text stays text; equal bytes
        drawn(graph, gpu_ms or {}).savefig(waiting, dpi=DPI, metadata=undated, facecolor=PAPER, format=kind)


def check_drawing(path: str | Path) -> Path:
    """`path` if a drawing can be written there, else `BadInput`."""
    return check_output(path, SUFFIXES, "drawings")


def drawn(graph: Plan, gpu_ms: Mapping[str, float | None]) -> Figure:
    """The figure, every length in points."""
    kept = {verdict.node.name for verdict in graph.verdicts if verdict.kept}
    places = layout([verdict.node for verdict in graph.verdicts], kept)
    left, right = min(places.across.values()) - WIDTH / 2, max(places.across.values()) + WIDTH / 2
    top, bottom = HEIGHT / 2 + MARGIN, -ROW * (len(places.layers) - 1) - HEIGHT / 2 - 2 * MARGIN
    figure = Figure(figsize=((right - left + 2 * MARGIN) / POINTS, (top - bottom) / POINTS))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(left - MARGIN, right + MARGIN), ylim=(bottom, top))
    axes.set_axis_off()
    for line in places.lines:
        draw_line(axes, places, line)
    draw_labels(axes, places)
    for verdict in graph.verdicts:
        note = milliseconds(gpu_ms.get(verdict.node.name)) if not verdict.merged else "computed by its reader"
        draw_node(axes, verdict.node, point(places, verdict.node.name), verdict.kept, note)
    draw_key(axes, left, bottom + MARGIN / 2)
    return figure


def point(places: Layout, place: str | Joint) -> tuple[float, float]:
    """The middle of a box or joint."""
    return places.across[place], -ROW * places.layer[place]


def port(places: Layout, line: Line, outgoing: bool) -> tuple[float, float]:
    """Where a line leaves or enters: lines of one box stand side by side in the order of where they go."""
    place, side = (line.start, -1) if outgoing else (line.end, 1)
    x, y = point(places, place)
    if isinstance(place, tuple):
        return x, y
    beside: dict[str, list[float]] = {}
    for other in places.lines:
        if (other.start if outgoing else other.end) == place:
            beside.setdefault(other.resource, []).append(places.across[other.end if outgoing else other.start])
    order = sorted(beside, key=lambda resource: sum(beside[resource]) / len(beside[resource]))
    step = WIDTH / (len(order) + (0 if outgoing else 1))
    return x + step * (order.index(line.resource) - (len(order) - 1) / 2), y + side * HEIGHT / 2


def draw_line(axes: Any, places: Layout, line: Line) -> None:
    """A piece of a trunk, with a tip where it is read."""
    (x0, y0), (x1, y1) = port(places, line, True), port(places, line, False)
    bend = (y0 - y1) / 2
    curve = Curve([(x0, y0), (x0, y0 - bend), (x1, y1 + bend), (x1, y1)], [1, 4, 4, 4])
    colour = INK if line.alive else GREY
    style = "solid" if line.alive else DASHED
    axes.add_patch(
        PathPatch(curve, fill=False, edgecolor=colour, linestyle=style, linewidth=1.1, zorder=2 if line.alive else 1)
    )
    if isinstance(line.end, str):
        tip = [(x1, y1), (x1 - 3, y1 + 6), (x1 + 3, y1 + 6)]
        axes.add_patch(Polygon(tip, facecolor=colour, edgecolor="none", zorder=2))


def draw_labels(axes: Any, places: Layout) -> None:
    """The name of every resource where it leaves a box that has another name."""
    alive: dict[tuple[str, str], bool] = {}
    for line in places.lines:
        if isinstance(line.start, str) and line.start != line.resource:
            alive[line.start, line.resource] = alive.get((line.start, line.resource), False) or line.alive
    for line in places.lines:
        if isinstance(line.start, str) and (line.start, line.resource) in alive:
            x, y = port(places, line, True)
            colour = INK if alive.pop((line.start, line.resource)) else GREY
            paper = {"facecolor": PAPER, "edgecolor": "none", "pad": 0.6}
            axes.text(
                x, y - 9, line.resource, fontsize=SMALL, color=colour, ha="center", va="center", bbox=paper, zorder=3
            )


def draw_node(axes: Any, node: Node, middle: tuple[float, float], kept: bool, note: str) -> None:
    """A box with the node's name and a note under it."""
    fill, edge = COLOURS[type(node).__name__] if kept else (PAPER, GREY)
    axes.add_patch(
        box(type(node).__name__, middle, WIDTH, HEIGHT, fill, edge, "solid" if kept else DASHED, f"node {node.name}")
    )
    x, y = middle
    colour = INK if kept else GREY
    kind = {"ha": "center", "va": "center", "color": colour, "zorder": 4}
    axes.text(x, y + (5 if note else 0), node.name, fontsize=NORMAL, **kind)
    axes.text(x, y - 8, note, fontsize=SMALL, **kind)


def box(
    kind: str, middle: tuple[float, float], width: float, height: float, fill: str, edge: str, style: Any, name: str
) -> Any:
    """Rounded for what the processor makes, cut at the corners for a choice, else square."""
    x, y = middle
    look = {"facecolor": fill, "edgecolor": edge, "linestyle": style, "linewidth": 1.3, "gid": name, "zorder": 3}
    if kind == "Choice":
        c = height / 3
        ends = [(x + sx * (width / 2 - dx), y + sy * (height / 2 - dy)) for sx, sy, dx, dy in corners(c)]
        return Polygon(ends, **look)
    rounding = 0.4 * height if kind == "Bake" else 2
    corner = (x - width / 2, y - height / 2)
    return FancyBboxPatch(corner, width, height, boxstyle=f"round,pad=0,rounding_size={rounding}", **look)


def corners(cut: float) -> list[tuple[int, int, float, float]]:
    """Signs and insets of the eight ends of a box with its corners cut off, in turn."""
    turns = [(1, 1), (1, -1), (-1, -1), (-1, 1)]
    return [(x, y, *inset) for x, y in turns for inset in ([(cut, 0), (0, cut)] if x == y else [(0, cut), (cut, 0)])]


def draw_key(axes: Any, left: float, y: float) -> None:
    """What the boxes mean."""
    for number, (kind, fill, edge, style, text) in enumerate(KEY):
        x = left + number * 150
        axes.add_patch(box(kind, (x + 11, y), 22, 12, fill, edge, style, f"key {text}"))
        axes.text(x + 28, y, text, fontsize=SMALL, color=INK, va="center")


def milliseconds(time: float | None) -> str:
    """A time on the GPU, or nothing."""
    return "" if time is None else f"{time:.2f} ms"
