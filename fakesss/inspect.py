"""Looking inside a picture: which passes ran and why, and what each of them wrote."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.colour import decode_srgb
from fakesss.frame import Made
from fakesss.frame_graph import Bake, FrameGraph, Plan, Verdict
from fakesss.pipeline import NONE, build, samples_of
from fakesss.quality import provenance
from fakesss.renderer import PICTURE, timed_rendering
from fakesss.savings import measured
from fakesss.scene import Scene
from fakesss.shapes import load_object
from fakesss.solidity import is_solid

Float = NDArray[np.float64]


def explain(scene: Scene, timed: bool = False) -> dict[str, Any]:
    """The contract's `explain` document: every pass and baked input, kept or culled, and why.

    Needs no OpenGL unless `timed`; without it times and `cached` are None.
    """
    return document(compiled(scene), scene, timed)


def document(plan: Plan, scene: Scene, timed: bool) -> dict[str, Any]:
    """`explain` of a compiled scene."""
    passes: dict[str, Any] = {}
    baked: dict[str, Made] = {}
    if timed:
        drawn = timed_rendering(scene)
        passes, baked = {entry["name"]: entry["gpu_ms"] for entry in drawn.passes}, drawn.baked
    return {
        "passes": [
            {**described(verdict), "gpu_ms": passes.get(verdict.node.name)}
            for verdict in plan.verdicts
            if not isinstance(verdict.node, Bake)
        ],
        "baked": [
            baked_entry(verdict, scene, baked.get(verdict.node.name))
            for verdict in plan.verdicts
            if isinstance(verdict.node, Bake)
        ],
        **({"quality": {"name": scene.quality, "settings": provenance(scene)}} if scene.quality else {}),
    }


def compiled(scene: Scene, forced: frozenset[str] = NONE) -> Plan:
    """The plan of the scene's picture, with the effects `forced` although they weigh nothing."""
    return declared(scene, forced).compile((PICTURE,))


def declared(scene: Scene, forced: frozenset[str] = NONE) -> FrameGraph:
    """The graph of the scene's picture; reads the mesh, since the cheapest exact way depends on what it is."""
    return build(scene, samples_of(scene), is_solid(load_object(scene.object)), forced)


def savings(scene: Scene) -> list[dict[str, Any]]:
    """What leaving out each effect that weighs nothing saves, measured; see `savings.measured`."""
    return measured(scene, lambda forced: compiled(scene, forced))


def described(verdict: Verdict) -> dict[str, Any]:
    """One pass, without its times."""
    node = verdict.node
    return {
        "name": node.name,
        "kept": verdict.kept,
        "because": verdict.because,
        "reads": list(node.reads),
        "writes": list(node.writes),
    }


def baked_entry(verdict: Verdict, scene: Scene, made: Made | None) -> dict[str, Any]:
    """One baked input; `rays` a vertex where it casts any."""
    rays = {"occlusion": scene.occlusion.rays, "local_thickness": scene.layers.rays}
    return {
        "name": verdict.node.name,
        "kept": verdict.kept,
        "because": verdict.because,
        "rays": rays.get(verdict.node.name),
        "seconds": made.seconds if made else None,
        "cached": made.cached or getattr(made.value, "cached", False) if made else None,
    }


def graph(scene: Scene) -> str:
    """Graphviz source of the scene's frame graph, culled nodes dashed."""
    graph = declared(scene)
    return graph.to_dot(graph.compile((PICTURE,)))


def contact_sheet(scene: Scene) -> Float:
    """All of `fakesss.views` and the picture on one labelled sheet: (H, W, 3) linear RGB."""
    from fakesss.contact_sheet import layered  # loads matplotlib
    from fakesss.views import ROWS, views

    made = views(scene)
    sheet = layered([{name: made[name] for name in row} for row in ROWS])
    return decode_srgb(np.asarray(sheet) / 255.0)
