"""The `explain` document as a person reads it."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from fakesss.frame_graph import Bake, Choice, Pass, Plan, Verdict
from fakesss.memory import peak_bytes, written_bytes

MEGABYTE = 1e6
INDENT = 10  # columns before what belongs to a node


def explained(plan: Plan, document: Mapping[str, Any]) -> Iterator[str]:
    """What is kept in the order it runs, then what is culled; `document` is that of `inspect.explain`."""
    entries = {entry["name"]: entry for entry in (*document["baked"], *document["passes"])}
    width = max(len(verdict.node.name) for verdict in plan.verdicts) + 2
    kept = [verdict for verdict in plan.verdicts if verdict.kept]
    yield f"KEPT  {len(kept)} of {len(plan.verdicts)}, in this order; {totals(plan, document)}"
    for verdict in kept:
        yield from described(verdict, entries[verdict.node.name], width)
    culled = [verdict for verdict in plan.verdicts if not verdict.kept]
    yield f"CULLED  {len(culled)}: not drawn, not baked, no memory"
    for verdict in culled:
        yield f"  {verdict.node.name:{width}}{verdict.because}"
    if quality := document.get("quality"):
        yield f"QUALITY  {quality['name']}: of the settings it names,"
        for giver in ("quality", "scene"):
            given = [f"{path} = {one['value']}" for path, one in quality["settings"].items() if one["from"] == giver]
            yield f"  from the {giver:{INDENT}}{', '.join(given) or 'none'}"


def described(verdict: Verdict, entry: Mapping[str, Any], width: int) -> Iterator[str]:
    """A kept node: kind, cost and reason; under it what it reads and writes."""
    node = verdict.node
    yield f"  {node.name:{width}}{', '.join((kind(verdict), *costs(verdict, entry)))}"
    yield f"  {'':{width}}{verdict.because}"
    reads = ", ".join(node.reads) or "the scene's object"
    yield f"  {'':{width}}{reads} -> {', '.join(node.writes)}"


def kind(verdict: Verdict) -> str:
    """How the node is made."""
    if verdict.merged:
        return "computed in place"
    return {Pass: "drawn", Bake: "baked", Choice: "chosen"}[type(verdict.node)]


def costs(verdict: Verdict, entry: Mapping[str, Any]) -> Iterator[str]:
    """Memory of what is written and, where measured, time."""
    if entry.get("rays"):
        yield f"{entry['rays']} rays a vertex"
    if entry.get("seconds") is not None:
        yield f"{entry['seconds']:.2f} s{' (was at hand)' if entry['cached'] else ''}"
    if not verdict.merged and (written := written_bytes(verdict.node)):
        yield f"{written / MEGABYTE:.1f} MB"
    if entry.get("gpu_ms") is not None:
        yield f"{entry['gpu_ms']:.2f} ms"


def totals(plan: Plan, document: Mapping[str, Any]) -> str:
    """Memory of the picture's textures and, where measured, time on the GPU."""
    times = [entry["gpu_ms"] for entry in document["passes"] if entry["gpu_ms"] is not None]
    drawn = f", {sum(times):.2f} ms" if times else ""
    return f"{peak_bytes(plan) / MEGABYTE:.1f} MB of textures{drawn}"


def saved(savings: Sequence[Mapping[str, Any]] | None) -> Iterator[str]:
    """The `savings` of an explain document; nothing where they were not measured."""
    if savings is None:
        return
    yield "SAVED  against the same picture with the effect forced on"
    if not savings:
        yield "  nothing: no effect of this scene weighs zero"
    for row in savings:
        time = f"{row['saved_ms']:.1f} ± {row['noise_ms']:.1f} of {row['forced_ms']:.1f} ms"
        memory = f"{(row['forced_bytes'] - row['bytes']) / MEGABYTE:.1f} of {row['forced_bytes'] / MEGABYTE:.1f} MB"
        baked = f", {row['bake_seconds']:.2f} s of baking once" if row["bake_seconds"] else ""
        same = "no byte of the picture changes" if row["same_bytes"] else "THE PICTURE CHANGES"
        yield f"  {', '.join(row['effects'])}: {row['because']}"
        yield f"  {'':{INDENT}}{time}, {memory}{baked}; {same}"
