"""Places for the nodes of a frame graph and for the lines between them, layer under layer.

After Sugiyama, Tagawa and Toda, *Methods for visual understanding of hierarchical system structures* (1981): a node
stands below all it reads, lines cross as little as the barycentre rule finds, and what belongs together stands upright.
One resource is one trunk with a branch to each reader, however many there are.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import isotonic_regression

from fakesss.frame_graph import Node, Pass

WIDTH, BEND = 124.0, 12.0  # of a box and of a line passing by
APART = 22.0  # between neighbours in a layer
SWEEPS = 24
STRAIGHT = 3.0  # how much more a joint than a box is held to its neighbours (Gansner et al. 1993 take 1, 2 and 8)
Joint = tuple[str, int]  # where a resource's trunk passes a layer


@dataclass(frozen=True)
class Line:
    """One piece of a resource's trunk, from a node or joint down to one in the next layer."""

    resource: str
    start: str | Joint
    end: str | Joint
    alive: bool  # somebody kept reads the resource through this piece


@dataclass(frozen=True)
class Layout:
    """Layers of node names and joints from the top, the middle of each across, and the lines."""

    layers: Sequence[Sequence[str | Joint]]
    across: Mapping[str | Joint, float]
    lines: Sequence[Line]

    @property
    def layer(self) -> dict[str | Joint, int]:
        """The number of the layer of each node and joint."""
        return {place: number for number, places in enumerate(self.layers) for place in places}


def layout(nodes: Sequence[Node], kept: Iterable[str]) -> Layout:
    """Where to draw `nodes`, given in an order in which each reads only what earlier ones write."""
    writer = {resource: node.name for node in nodes for resource in node.writes}
    depth: dict[str, int] = {}
    for node in nodes:
        depth[node.name] = 1 + max((depth[writer[name]] for name in inputs(node)), default=-1)
    lines = trunks(nodes, set(kept), writer, depth)
    layers: list[list[str | Joint]] = [[] for _ in range(max(depth.values()) + 1)]
    for name, number in depth.items():
        layers[number].append(name)
    for place in dict.fromkeys(line.end for line in lines if isinstance(line.end, tuple)):
        layers[place[1]].append(place)
    near = neighbours(lines)
    for sweep in range(SWEEPS):
        untangle(layers, near, downwards=sweep % 2 == 0)
    return Layout(layers, straightened(layers, near), lines)


def inputs(node: Node) -> tuple[str, ...]:
    """What a node reads, what it computes in another's place, and what it could read."""
    return tuple(dict.fromkeys((*read(node), *node.unread)))


def read(node: Node) -> tuple[str, ...]:
    """What a node reads, and what it computes in another's place."""
    in_place = node.merged if isinstance(node, Pass) else ()
    return (*node.reads, *(resource for other in in_place for resource in other.writes))


def trunks(nodes: Sequence[Node], kept: set[str], writer: Mapping[str, str], depth: Mapping[str, int]) -> list[Line]:
    """The lines of every resource; a piece that leads to several readers is there once."""
    alive: dict[tuple[str, str | Joint, str | Joint], bool] = {}
    for node in nodes:
        for resource in inputs(node):
            first, last = depth[writer[resource]], depth[node.name]
            stops: list[str | Joint] = [
                writer[resource],
                *((resource, number) for number in range(first + 1, last)),
                node.name,
            ]
            reads = node.name in kept and resource in read(node)
            for piece in pairwise(stops):
                alive[resource, *piece] = alive.get((resource, *piece), False) or reads
    return [Line(*piece, reads) for piece, reads in alive.items()]


def neighbours(lines: Iterable[Line]) -> dict[bool, dict[str | Joint, list[str | Joint]]]:
    """For each place those it is joined to above (under True) and below (under False)."""
    near: dict[bool, dict[str | Joint, list[str | Joint]]] = {True: {}, False: {}}
    for line in lines:
        near[True].setdefault(line.end, []).append(line.start)
        near[False].setdefault(line.start, []).append(line.end)
    return near


def untangle(
    layers: list[list[str | Joint]], near: Mapping[bool, Mapping[str | Joint, list[str | Joint]]], downwards: bool
) -> None:
    """Order each layer, in place, by the mean position of the neighbours in the layer just passed."""
    for layer in layers if downwards else layers[::-1]:
        position = {place: i - (len(other) - 1) / 2 for other in layers for i, place in enumerate(other)}
        mean = {
            place: float(np.mean([position[other] for other in near[downwards].get(place, [place])])) for place in layer
        }
        layer.sort(key=lambda place: mean[place])


def straightened(
    layers: Sequence[Sequence[str | Joint]], near: Mapping[bool, Mapping[str | Joint, list[str | Joint]]]
) -> dict[str | Joint, float]:
    """Positions across that keep the order and the room of each place and are close to the neighbours' mean."""
    across = {place: 0.0 for layer in layers for place in layer}
    for sweep in range(4 * SWEEPS):
        for layer in layers if sweep % 2 else layers[::-1]:
            room = np.array([WIDTH if isinstance(place, str) else BEND for place in layer])
            offset = np.concatenate([[0.0], np.cumsum((room[1:] + room[:-1]) / 2 + APART)])
            wanted = [pulled(place, near, across) for place in layer]
            # keeping at least `offset` between neighbours is keeping the differences in order (Barlow 1972)
            weight = np.where(room == WIDTH, 1.0, STRAIGHT)
            placed = isotonic_regression(np.array(wanted) - offset, weights=weight).x + offset
            across.update(zip(layer, placed.tolist(), strict=True))
    return across


def pulled(
    place: str | Joint,
    near: Mapping[bool, Mapping[str | Joint, list[str | Joint]]],
    across: Mapping[str | Joint, float],
) -> float:
    """Where the neighbours pull a place to: a trunk from joint to joint pulls hardest, so that it runs straight."""
    others = [other for side in near.values() for other in side.get(place, [])]
    if not others:
        return across[place]
    weights = [STRAIGHT ** (isinstance(place, tuple) + isinstance(other, tuple)) for other in others]
    return float(np.average([across[other] for other in others], weights=weights))
