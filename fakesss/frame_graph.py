"""A frame graph: passes declare what they read and write; only what a target needs is run.

After O'Donnell, "FrameGraph: Extensible Rendering Architecture in Frostbite" (GDC 2017): declare, compile, run.
Two rules keep it small. A resource is written once, so a name is a version. A pass reads only names written before
it, so a cycle cannot be written down. Declaring and compiling need no GPU.
"""

from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Literal


class FrameGraphError(ValueError):
    """The graph as declared cannot be run; the message names the pass and the resource."""


DEPTH = 0  # components of a depth buffer


@dataclass(frozen=True)
class TextureSpec:
    """A transient texture. Equal specs share memory when their lives do not overlap."""

    size: tuple[int, int]  # (width, height), pixels
    components: int  # 1..4, or DEPTH
    numbers: Literal["float32", "float16"] = "float32"  # that it is kept in; a depth buffer has its own

    @property
    def bytes(self) -> int:
        """Its memory; a depth buffer takes four bytes a pixel."""
        return self.size[0] * self.size[1] * (2 if self.numbers == "float16" else 4) * max(self.components, 1)


@dataclass(frozen=True, eq=False)
class Pass:
    """One node that draws: `draw(frame)` fills the textures named in `writes` and sees only what it declared.

    `unread` tells, for inputs that this pass could read but this scene does not call for, the reason in words;
    `only_for` names the output without which an input is not needed.
    Textures are set to `clear` before `draw`, but those of `read_masked`, which nothing reads where the object is not,
    only if they are asked for. `depth_test` attaches an emptied depth buffer, one of `writes` if that
    names one. `mask` names a depth buffer among `reads`: only samples that it covers are drawn. `add` sums what is
    drawn instead of keeping the last.
    `in_place`: the uniforms and defines of a full-screen pass whose reader can compute its output itself, given the
    pass's inputs; a reader that can lists the output in `merges`.
    Equal `key(inputs)` promise equal outputs, so what was drawn for one picture serves the next.
    """

    name: str
    draw: Callable[[Any], None]
    writes: Mapping[str, TextureSpec]
    reads: tuple[str, ...] = ()
    unread: Mapping[str, str] = field(default_factory=dict)
    only_for: Mapping[str, str] = field(default_factory=dict)
    depth_test: bool = False
    mask: str = ""
    clear: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    read_masked: tuple[str, ...] = ()
    add: bool = False
    in_place: Callable[[Mapping[str, Any]], tuple[dict[str, Any], dict[str, int]]] | None = None
    merges: tuple[str, ...] = ()
    key: Callable[[Mapping[str, Any]], Hashable] | None = None
    merged: tuple["Pass", ...] = ()  # filled by `compile`


@dataclass(frozen=True, eq=False)
class Choice:
    """One of several resources under a name of its own; `unread` says why not the others. Nothing is copied."""

    name: str
    chosen: str
    because: str
    unread: Mapping[str, str]

    @property
    def reads(self) -> tuple[str, ...]:
        return (self.chosen,)

    @property
    def writes(self) -> Mapping[str, None]:
        return {self.name: None}


@dataclass(frozen=True, eq=False)
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


Node = Pass | Bake | Choice


@dataclass(frozen=True)
class Verdict:
    """What `compile` decided about one node, and why, in words a person understands."""

    node: Node
    kept: bool
    why: Callable[[], str] = field(compare=False)  # put into words only when asked
    merged: bool = False  # kept, but computed by its reader

    @property
    def because(self) -> str:
        return self.why()


@dataclass(frozen=True)
class Plan:
    """Every node's verdict in order of declaration, and the resources that die after each kept node."""

    verdicts: tuple[Verdict, ...]
    targets: tuple[str, ...]
    dead_after: Mapping[str, tuple[str, ...]]
    aliases: Mapping[str, str]  # from a choice's name to the resource chosen

    @property
    def kept(self) -> tuple[Pass | Bake, ...]:
        """The nodes to run, in order."""
        nodes = (verdict.node for verdict in self.verdicts if verdict.kept and not verdict.merged)
        return tuple(node for node in nodes if not isinstance(node, Choice))

    @property
    def passes(self) -> tuple[str, ...]:
        """Names of the kept drawing passes in the order they run, those that a reader computes among them."""
        return tuple(v.node.name for v in self.verdicts if v.kept and isinstance(v.node, Pass))

    def root(self, resource: str) -> str:
        """The resource itself, for a choice's name."""
        while resource in self.aliases:
            resource = self.aliases[resource]
        return resource


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
        nodes, wanted = self._wanted(set(targets))
        kept = [node for node in nodes if not wanted.isdisjoint(node.writes)]
        culled = [node for node in nodes if wanted.isdisjoint(node.writes)]
        verdicts = [
            Verdict(node, False, partial(why_culled, node, kept, culled))
            if wanted.isdisjoint(node.writes)
            else Verdict(node, True, partial(why_kept, node, kept, targets))
            for node in nodes
        ]
        aliases = {node.name: node.chosen for node in nodes if isinstance(node, Choice)}
        plan = Plan(tuple(merged(verdicts, targets)), targets, {}, aliases)
        last_use = {plan.root(resource): node.name for node in plan.kept for resource in (*node.writes, *node.reads)}
        alive = {plan.root(target) for target in targets}
        dead_after = {
            node.name: tuple(r for r, last in last_use.items() if last == node.name and r not in alive)
            for node in plan.kept
        }
        return replace(plan, dead_after=dead_after)

    def _wanted(self, wanted: set[str]) -> tuple[list[Node], set[str]]:
        """Every node without the inputs that serve nothing wanted, and all that is wanted for `wanted`."""
        nodes: list[Node] = []
        for declared in reversed(self.nodes):
            node = without_idle_inputs(declared, wanted)
            nodes.insert(0, node)
            if wanted.intersection(node.writes):
                wanted = wanted.union(node.reads)
        return nodes, wanted

    def to_dot(self, plan: Plan | None = None) -> str:
        """Graphviz source: passes as boxes, baked inputs as houses, resources as edges; what is culled is dashed."""
        nodes = [verdict.node for verdict in plan.verdicts if verdict.kept] if plan else self.nodes
        kept = {node.name for node in nodes}
        lines = ["digraph frame {", "  rankdir=LR; node [fontname=Helvetica]; edge [fontname=Helvetica fontsize=10]"]
        for node in self.nodes:
            style = "solid" if node.name in kept else "dashed"
            shape = {Bake: "house", Choice: "diamond"}.get(type(node), "box")
            lines.append(f'  "{node.name}" [shape={shape} style={style}]')
            for resource in (*node.reads, *node.unread):
                alive = "solid" if style == "solid" and resource in node.reads else "dashed"
                source = self.writer[resource].name
                lines.append(f'  "{source}" -> "{node.name}" [label="{resource}" style={alive}]')
        return "\n".join([*lines, "}\n"])


def without_idle_inputs(node: Node, wanted: set[str]) -> Node:
    """`node` reading only what serves a wanted output."""
    if not isinstance(node, Pass):
        return node
    idle = {name: f"{output} is not wanted" for name, output in node.only_for.items() if output not in wanted}
    reads = tuple(name for name in node.reads if name not in idle)
    return replace(node, reads=reads, unread={**idle, **node.unread})


def merged(verdicts: list[Verdict], targets: tuple[str, ...]) -> list[Verdict]:
    """The verdicts with every pass that its only reader can compute in place merged into that reader."""
    for index, verdict in enumerate(verdicts):
        node = verdict.node
        if not verdict.kept or not isinstance(node, Pass) or node.in_place is None:
            continue
        places = [
            place
            for place, other in enumerate(verdicts)
            if other.kept and not other.merged and set(other.node.reads).intersection(node.writes)
        ]
        reader = verdicts[places[0]].node if len(places) == 1 else None
        if not isinstance(reader, Pass) or set(targets).intersection(node.writes):
            continue
        if not set(node.writes).issubset(reader.merges):
            continue
        reads = dict.fromkeys((*(name for name in reader.reads if name not in node.writes), *node.reads))
        united = replace(reader, reads=tuple(reads), merged=(*reader.merged, node))
        verdicts[places[0]] = replace(verdicts[places[0]], node=united)
        verdicts[index] = replace(verdict, merged=True, why=partial(str, f"computed by {reader.name}, its only reader"))
    return verdicts


def why_kept(node: Node, kept: list[Node], targets: tuple[str, ...]) -> str:
    """Who asks for what the node writes; of a choice also why it chose so."""
    asked = [f"{resource} is asked for" for resource in node.writes if resource in targets]
    asked = asked or [f"read by {in_words(readers_of(node, kept))}"]
    if isinstance(node, Choice):
        asked.append(f"{node.chosen}: {node.because}")
    return "; ".join(asked)


def why_culled(node: Node, kept: list[Node], culled: list[Node]) -> str:
    """Which settings keep the others from reading what the node writes."""
    reasons = [
        f"not read by {other.name}: {why}"
        for other in (*kept, *culled)
        for resource, why in other.unread.items()
        if resource in node.writes
    ]
    if readers := readers_of(node, culled):
        reasons.append(f"read only by {in_words(readers)}, which {'are' if len(readers) > 1 else 'is'} culled")
    return "; ".join(dict.fromkeys(reasons)) or "nothing that is asked for reads it"


def readers_of(node: Node, others: Iterable[Node]) -> list[str]:
    """Names of those among `others` that read what `node` writes."""
    return [other.name for other in others if any(resource in node.writes for resource in other.reads)]


def in_words(names: list[str]) -> str:
    """`a`, `a and b`, `a, b and c`."""
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
