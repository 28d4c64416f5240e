"""A frame graph: passes declare what they read and write; only what a target needs is run.

After O'Donnell, "FrameGraph: Extensible Rendering Architecture in Frostbite" (GDC 2017): declare, compile, run.
Two rules keep it small. A resource is written once, so a name is a version. A pass reads only names written before
it, so a cycle cannot be written down. Declaring and compiling need no GPU.
"""

from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any


class FrameGraphError(ValueError):
    """The graph as declared cannot be run; the message names the pass and the resource."""


@dataclass(frozen=True)
class TextureSpec:
    """A transient float32 texture. Equal specs share memory when their lives do not overlap."""

    size: tuple[int, int]  # (width, height), pixels
    components: int  # 1..4


@dataclass(frozen=True)
class Pass:
    """One node that draws: `draw(frame)` fills the textures named in `writes` and sees only what it declared.

    `unread` tells, for inputs that this pass could read but this scene does not call for, the reason in words;
    `only_for` names the output without which an input is not needed.
    Textures are cleared to 0 before `draw`; with `depth_test` an emptied depth buffer is attached.
    """

    name: str
    draw: Callable[[Any], None]
    writes: Mapping[str, TextureSpec]
    reads: tuple[str, ...] = ()
    unread: Mapping[str, str] = field(default_factory=dict)
    only_for: Mapping[str, str] = field(default_factory=dict)
    depth_test: bool = False


@dataclass(frozen=True)
class Bake:
    """One node made on the CPU (a mesh, its occlusion): `make(inputs)` returns the resource called `name`.

    Equal `key(inputs)` promise equal results, so what was made for one picture serves the next.
    """

    name: str
    make: Callable[[Mapping[str, Any]], Any]
    key: Callable[[Mapping[str, Any]], Hashable]
    reads: tuple[str, ...] = ()
    unread: Mapping[str, str] = field(default_factory=dict)

    @property
    def writes(self) -> Mapping[str, None]:
        return {self.name: None}


Node = Pass | Bake


@dataclass(frozen=True)
class Verdict:
    """What `compile` decided about one node, and why, in words a person understands."""

    node: Node
    kept: bool
    because: str


@dataclass(frozen=True)
class Plan:
    """Every node's verdict in order of declaration, and the resources that die after each kept node."""

    verdicts: tuple[Verdict, ...]
    targets: tuple[str, ...]
    dead_after: Mapping[str, tuple[str, ...]]

    @property
    def kept(self) -> tuple[Node, ...]:
        return tuple(verdict.node for verdict in self.verdicts if verdict.kept)

    @property
    def passes(self) -> tuple[str, ...]:
        """Names of the kept drawing passes, in the order they run."""
        return tuple(node.name for node in self.kept if isinstance(node, Pass))


class FrameGraph:
    """Nodes in the order they were added, and who writes each resource."""

    def __init__(self, nodes: Iterable[Node] = ()) -> None:
        self.nodes: list[Node] = []
        self.writer: dict[str, Node] = {}
        for node in nodes:
            self.add(node)

    def add(self, node: Node) -> None:
        """Declare a node. Nothing is allocated, baked or drawn."""
        if any(node.name == earlier.name for earlier in self.nodes):
            raise FrameGraphError(f'two passes are named "{node.name}"')
        for resource in (*node.reads, *node.unread):
            if resource not in self.writer:
                raise FrameGraphError(f'pass "{node.name}" reads "{resource}", which nothing before it writes')
        for resource in node.writes:
            if resource in self.writer:
                raise FrameGraphError(
                    f'pass "{node.name}" writes "{resource}", already written by "{self.writer[resource].name}"'
                )
        self.nodes.append(node)
        self.writer.update(dict.fromkeys(node.writes, node))

    def compile(self, targets: Iterable[str]) -> Plan:
        """Keep what `targets` depend on; note where each resource is last read and why each node is kept or not."""
        targets = tuple(targets)
        for target in targets:
            if target not in self.writer:
                raise FrameGraphError(f'target "{target}" is written by no pass; there are {", ".join(self.writer)}')
        nodes: list[Node] = []
        wanted = set(targets)
        for declared in reversed(self.nodes):
            node = without_idle_inputs(declared, wanted)
            nodes.insert(0, node)
            if wanted.intersection(node.writes):
                wanted.update(node.reads)
        kept = [node for node in nodes if wanted.intersection(node.writes)]
        last_use = {resource: node.name for node in kept for resource in (*node.writes, *node.reads)}
        dead_after = {
            node.name: tuple(r for r, last in last_use.items() if last == node.name and r not in targets)
            for node in kept
        }
        culled = [node for node in nodes if node not in kept]
        verdicts = [
            Verdict(node, True, why_kept(node, kept, targets))
            if node in kept
            else Verdict(node, False, why_culled(node, kept, culled))
            for node in nodes
        ]
        return Plan(tuple(verdicts), targets, dead_after)

    def to_dot(self, plan: Plan | None = None) -> str:
        """Graphviz source: passes as boxes, baked inputs as houses, resources as edges; what is culled is dashed."""
        kept = {node.name for node in (plan.kept if plan else self.nodes)}
        lines = ["digraph frame {", "  rankdir=LR; node [fontname=Helvetica]; edge [fontname=Helvetica fontsize=10]"]
        for node in self.nodes:
            style = "solid" if node.name in kept else "dashed"
            shape = "house" if isinstance(node, Bake) else "box"
            lines.append(f'  "{node.name}" [shape={shape} style={style}]')
            for resource in (*node.reads, *node.unread):
                alive = "solid" if style == "solid" and resource in node.reads else "dashed"
                source = self.writer[resource].name
                lines.append(f'  "{source}" -> "{node.name}" [label="{resource}" style={alive}]')
        return "\n".join([*lines, "}\n"])


def without_idle_inputs(node: Node, wanted: set[str]) -> Node:
    """`node` reading only what serves a wanted output."""
    if isinstance(node, Bake):
        return node
    idle = {name: f"{output} is not wanted" for name, output in node.only_for.items() if output not in wanted}
    reads = tuple(name for name in node.reads if name not in idle)
    return replace(node, reads=reads, unread={**idle, **node.unread})


def why_kept(node: Node, kept: list[Node], targets: tuple[str, ...]) -> str:
    """Who asks for what the node writes."""
    asked = [f"{resource} is asked for" for resource in node.writes if resource in targets]
    return "; ".join(asked) or f"read by {in_words(readers_of(node, kept))}"


def why_culled(node: Node, kept: list[Node], culled: list[Node]) -> str:
    """Which settings keep the others from reading what the node writes."""
    reasons = [
        f"not read by {other.name}: {why}"
        for other in kept
        for resource, why in other.unread.items()
        if resource in node.writes
    ]
    if readers := readers_of(node, culled):
        reasons.append(f"read only by {in_words(readers)}, which {'are' if len(readers) > 1 else 'is'} culled")
    return "; ".join(dict.fromkeys(reasons)) or "nothing that is asked for reads it"


def readers_of(node: Node, others: Iterable[Node]) -> list[str]:
    """Names of those among `others` that read what `node` writes."""
    return [other.name for other in others if set(other.reads).intersection(node.writes)]


def in_words(names: list[str]) -> str:
    """`a`, `a and b`, `a, b and c`."""
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
