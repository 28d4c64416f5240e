"""Looking inside a picture: which passes ran and why, and what each of them wrote."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.colour import decode_srgb, to_8bit
from fakesss.contact_sheet import Panel, layered
from fakesss.frame import Made
from fakesss.frame_graph import Bake, Plan, Verdict
from fakesss.pipeline import build, samples_of
from fakesss.renderer import PICTURE, shared_renderer
from fakesss.scene import Scene

Float = NDArray[np.float64]
VIEWS = ("front", "second", "thickness", "blurred_thickness", "surface")
WITH_OCCLUSION = {"occlusion.enabled": True, "material.ambient": 1, "light.ambient": (1, 1, 1)}
ONLY_BACKLIGHT = {"material.ambient": 0, "material.diffuse_contribution": 0, "material.specular_contribution": 0}


def explain(scene: Scene, timed: bool = False) -> dict[str, Any]:
    """The contract's `explain` document: every pass and baked input, kept or culled, and why.

    Needs no OpenGL, and reads no mesh, unless `timed`; without it times and `cached` are None.
    """
    plan = compiled(scene)
    passes: dict[str, Any] = {}
    baked: dict[str, Made] = {}
    if timed:
        drawn = shared_renderer().render(scene, timed=True)
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
    }


def compiled(scene: Scene) -> Plan:
    """The plan of the scene's picture."""
    return build(scene, samples_of(scene)).compile((PICTURE,))


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
    """One baked input; only the occlusion has rays."""
    return {
        "name": verdict.node.name,
        "kept": verdict.kept,
        "because": verdict.because,
        "rays": scene.occlusion.rays if verdict.node.name == "occlusion" else None,
        "seconds": made.seconds if made else None,
        "cached": made.cached or getattr(made.value, "cached", False) if made else None,
    }


def graph(scene: Scene) -> str:
    """Graphviz source of the scene's frame graph, culled nodes dashed."""
    return build(scene, samples_of(scene)).to_dot(compiled(scene))


def contact_sheet(scene: Scene) -> Float:
    """Every intermediate and the picture on one labelled sheet: (H, W, 3) linear RGB.

    Intermediates are shown whether or not the picture calls for them; `explain` tells which it does.
    """
    renderer = shared_renderer()
    layers = renderer.data(scene.replace(WITH_OCCLUSION), VIEWS)
    covered = layers["front"] > 0
    glow = renderer.render(scene.replace(ONLY_BACKLIGHT)).image
    normals = np.where(covered[..., None], layers["surface"][..., :3] * 0.5 + 0.5, 0.0)
    panels = [
        Panel("front layer", layers["front"] - 1, covered, "depth into the sphere, radii", "cividis_r"),
        Panel("second layer", layers["second"] - 1, layers["second"] > 0, "same", "cividis_r"),
        Panel("thickness", layers["thickness"], covered, "sphere diameters", "magma_r"),
        Panel("softened thickness", layers["blurred_thickness"], covered, "what the light sees", "magma_r"),
        Panel("normals", to_8bit(decode_srgb(normals)), covered, "right, up, to the viewer"),
        Panel("occlusion", layers["surface"][..., 3], covered, "share of the hemisphere open", "gray", (0.0, 1.0)),
        Panel("backlight alone", to_8bit(glow[..., :3]), covered, "(1 - t)^r (Kd + Kb)"),
        Panel("picture", to_8bit(renderer.render(scene).image[..., :3]), covered, scene.object),
    ]
    return decode_srgb(np.asarray(layered(panels)) / 255.0)
