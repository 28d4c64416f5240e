"""The drawn frame graph: every node is there, culled ones are dashed, nothing overlaps."""

import xml.etree.ElementTree as ET
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from fakesss.frame_graph import Bake, FrameGraph, Pass, TextureSpec
from fakesss.graph_drawing import draw_graph
from fakesss.graph_layout import APART, BEND, WIDTH, layout
from fakesss.pipeline import build
from fakesss.problem import BadInput
from fakesss.scene import Scene

SVG = "{http://www.w3.org/2000/svg}"
CHANGES: list[dict[str, Any]] = [{}, {"material.backlight": 0.0}, {"material.thickness": "bridged"}]


def plan(changes: dict[str, Any]) -> Any:
    return build(Scene().replace(changes), 3, True).compile(["image"])


@pytest.mark.parametrize("changes", CHANGES, ids=str)
def test_the_svg_holds_every_node_and_dashes_what_is_culled(tmp_path: Path, changes: dict[str, Any]) -> None:
    graph = plan(changes)
    draw_graph(graph, tmp_path / "graph.svg", {"front": 12.5})
    root = ET.parse(tmp_path / "graph.svg").getroot()
    boxes = {group.get("id"): group for group in root.iter(f"{SVG}g") if (group.get("id") or "").startswith("node ")}
    assert boxes.keys() == {f"node {verdict.node.name}" for verdict in graph.verdicts}
    for verdict in graph.verdicts:
        style = next(boxes[f"node {verdict.node.name}"].iter(f"{SVG}path")).get("style") or ""
        assert ("stroke-dasharray" in style) != verdict.kept
    words = {element.text for element in root.iter(f"{SVG}text")}
    assert {verdict.node.name for verdict in graph.verdicts} | {"surface", "coverage", "shaded", "12.50 ms"} <= words


def test_equal_graphs_give_equal_files(tmp_path: Path) -> None:
    for name in ("a.svg", "b.svg"):
        draw_graph(plan({}), tmp_path / name)
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_png_and_pdf(tmp_path: Path) -> None:
    draw_graph(plan({}), tmp_path / "graph.png")
    picture = np.asarray(Image.open(tmp_path / "graph.png").convert("RGB"))
    assert picture.shape[0] > 500 and (picture[0, 0] == 255).all() and picture.min() < 60
    draw_graph(plan({}), tmp_path / "graph.pdf")
    assert (tmp_path / "graph.pdf").read_bytes().startswith(b"%PDF")


def test_bad_places_are_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r'"\.gif" is no format of drawings'):
        draw_graph(plan({}), tmp_path / "graph.gif")
    with pytest.raises(BadInput, match="does not exist; make it first"):
        draw_graph(plan({}), tmp_path / "no" / "graph.svg")


@pytest.mark.parametrize("changes", CHANGES, ids=str)
def test_readers_stand_below_and_nothing_overlaps(changes: dict[str, Any]) -> None:
    graph = plan(changes)
    nodes = [verdict.node for verdict in graph.verdicts]
    places = layout(nodes, [verdict.node.name for verdict in graph.verdicts if verdict.kept])
    assert all(places.layer[line.end] == places.layer[line.start] + 1 for line in places.lines)
    for layer in places.layers:
        for left, right in pairwise(layer):
            room = sum(WIDTH if isinstance(place, str) else BEND for place in (left, right)) / 2 + APART
            assert places.across[right] - places.across[left] >= room - 1e-6


def test_a_trunk_reaches_every_reader_once_and_is_alive_as_far_as_it_is_read() -> None:
    texture = TextureSpec((1, 1), 1)
    nodes = [
        Bake("mesh", lambda inputs: None, lambda inputs: 0),
        Pass("a", lambda frame: None, {"a": texture}, ("mesh",)),
        Pass("b", lambda frame: None, {"b": texture}, ("a", "mesh")),
        Pass("c", lambda frame: None, {"c": texture}, ("b",), unread={"mesh": "why not"}),
    ]
    compiled = FrameGraph(nodes).compile(["c"])
    lines = layout(nodes, [verdict.node.name for verdict in compiled.verdicts if verdict.kept]).lines
    trunk = {(line.start, line.end): line.alive for line in lines if line.resource == "mesh"}
    assert trunk == {
        ("mesh", "a"): True,
        ("mesh", ("mesh", 1)): True,
        (("mesh", 1), "b"): True,
        (("mesh", 1), ("mesh", 2)): False,
        (("mesh", 2), "c"): False,
    }
