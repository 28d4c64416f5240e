"""What each pass wrote, each lighting term alone, and what can go wrong: the panels of the contact sheet, by name."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View
from fakesss.colour import decode_srgb, to_8bit
from fakesss.contact_sheet import EMPTY, MARK, OTHER, Mark, Panel, Plot, Size
from fakesss.depth_checks import blur_width, depth_precision
from fakesss.hard_edges import FRONT_BOUND, JUMP, HardEdges, hard_edges, layer_breaks
from fakesss.lighting_terms import TERMS, lighting_term
from fakesss.profile_plot import Profile, profile_plot
from fakesss.relief import relief
from fakesss.renderer import shared_renderer
from fakesss.scene import Scene

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]
Views = dict[str, Panel | Plot]
Layers = Mapping[str, NDArray[Any]]

LAYERS = ("front", "second", "thickness", "blurred_thickness", "surface")
OCCLUSION = {"baked": "surface", "screen-space": "screen_occlusion"}  # where it lies; of the surface the last channel
WITH_OCCLUSION = {"occlusion.enabled": True, "material.ambient": 1, "light.ambient": (1, 1, 1)}
ROWS = (
    ("front", "second", "normals", "depth_gaps", "depth_precision"),
    ("thickness", "blurred_thickness", "softening", "blur_width", "hard_edges"),
    ("occlusion", *TERMS),
    ("picture", "relief", "profile"),
)
DEPTH, THICKNESS, SIGNED = "cividis_r", "magma_r", "berlin"  # near and thin are bright; no change is dark
BITS = (0.0, 23.0)  # of a float32's fraction
SQUARE = 0.1  # sphere diameters: the sides of the squares that the relief stands on
FLOOR = 0.02  # sphere diameters between the relief's board and the farthest point


def views(scene: Scene) -> Views:
    """Every view of `scene` by name, as docs/views.md describes them.

    A panel's `values` are data, (H, W) in the unit of its note, or 8-bit RGB (H, W, 3). All are made, whether or not
    the picture calls for them; `explain` tells which it does.
    """
    occlusion = OCCLUSION[scene.occlusion.method]
    layers = shared_renderer().data(scene.replace(WITH_OCCLUSION), tuple(dict.fromkeys((*LAYERS, occlusion))))
    edges = hard_edges(layers["front"], layers["thickness"])
    made = depths(layers) | thicknesses(layers, scene, edges) | lights(layers, scene) | plots(layers, scene, edges)
    return {name: made[name] for row in ROWS for name in row}


def pixel_width(scene: Scene) -> float:
    """Of a pixel at the sphere's centre, in sphere diameters; a camera inside the sphere sees it from its surface."""
    view = View.of(scene.camera, scene.size)
    return max(view.distance, 1.0) * view.tangent[0] / scene.size[0]


def depths(layers: Layers) -> Views:
    """The two layers, the front one's normals, and where depths break or repeat themselves."""
    front, second = layers["front"], layers["second"]
    covered = front > 0
    normals = np.where(covered[..., None], layers["surface"][..., :3] * 0.5 + 0.5, 0.0)
    bits, same = depth_precision(front)
    gaps = Mark(layer_breaks(second), OTHER, "second"), Mark(layer_breaks(front), MARK, "front")
    shared = (Mark(same, MARK, "shared"),)
    equal = f"{same.sum() / max(covered.sum(), 1):.1%} share a neighbour's depth"
    return {
        "front": Panel("front layer", front - 1, covered, "depth into the sphere, radii", DEPTH),
        "second": Panel("second layer", second - 1, second > 0, "depth into the sphere, radii", DEPTH),
        "normals": Panel("normals", to_8bit(decode_srgb(normals)), covered, "right, up, to the viewer"),
        "depth_gaps": Panel("depth gaps", front - 1, covered, f"jumps > {FRONT_BOUND} diameters", "gray_r", None, gaps),
        "depth_precision": Panel("precision, bits", bits, covered, equal, "viridis", BITS, shared),
    }


def thicknesses(layers: Layers, scene: Scene, edges: HardEdges) -> Views:
    """Both thicknesses, what softening changed and over which width, and where the exact one jumps."""
    exact, softened = layers["thickness"], layers["blurred_thickness"]
    covered, behind = layers["front"] > 0, layers["second"] > 0
    change = softened - exact
    most = max(float(np.percentile(np.abs(change[covered]), 99.5)), 1e-4) if covered.any() else 1.0
    both = (0.0, max(float(exact.max()), 1e-6))  # one scale, so that the two can be compared
    middle = scene.size[1] // 2
    jumps = f"{edges.share:.2%} of pixels, {edges.length(pixel_width(scene)):.2f} diameters long"
    width = blur_width(layers["second"], scene)
    return {
        "thickness": Panel("thickness", exact, covered, "sphere diameters", THICKNESS, both, line=middle),
        "blurred_thickness": Panel("softened thickness", softened, covered, "sphere diameters", THICKNESS, both),
        "softening": Panel("softened - exact", change, covered, "sphere diameters", SIGNED, (-most, most)),
        "blur_width": Panel("width of softening", width, behind, "sphere diameters, on the object", "viridis"),
        "hard_edges": Panel(
            "hard edges", exact, covered, jumps, "gray_r", None, (Mark(edges.mask, MARK, f"jump > {JUMP}"),)
        ),
    }


def lights(layers: Layers, scene: Scene) -> Views:
    """The occlusion, every term of the lighting equation alone, and the picture that they add up to."""
    covered = layers["front"] > 0
    everywhere = np.ones_like(covered)
    found = layers[OCCLUSION[scene.occlusion.method]]
    open_share = found if found.ndim == 2 else found[..., 3]
    image = shared_renderer().render(scene).image
    terms: Views = {}
    for name in TERMS:
        pixels, note = lighting_term(scene, name, np.array(EMPTY) / 255)
        terms[name] = Panel(name, pixels, everywhere, note)
    return {
        "occlusion": Panel("occlusion [a]", open_share, covered, "share of the hemisphere open", "gray", (0.0, 1.0)),
        **terms,
        "picture": Panel("picture", to_8bit(image[..., :3]), everywhere, scene.object),
    }


def runs(positions: Float, marked: Mask) -> list[float]:
    """The middle of every run of marked positions, both (W,)."""
    ends = np.flatnonzero(np.diff(marked, prepend=False, append=False))
    return [float(positions[first:last].mean()) for first, last in zip(ends[::2], ends[1::2], strict=True)]


def plots(layers: Layers, scene: Scene, edges: HardEdges) -> Views:
    """The front layer as a landscape, and the thickness along the middle row."""
    pixel, front = pixel_width(scene), layers["front"].astype(np.float64) / 2
    covered = front > 0
    heights = np.where(covered, front.max(initial=0.0) + FLOOR - front, 0.0)
    middle = scene.size[1] // 2
    thickness, softened = (
        np.where(covered[middle], layers[name][middle], np.nan) for name in ("thickness", "blurred_thickness")
    )
    across = (np.arange(scene.size[0], dtype=np.float64) + 0.5 - scene.size[0] / 2) * pixel
    profile = Profile(across, thickness, softened, runs(across, edges.mask[middle]))

    def landscape(size: Size) -> NDArray[np.uint8]:
        return relief(heights, covered, pixel, size, DEPTH.removesuffix("_r"), SQUARE)

    return {
        "relief": Plot("relief of the front layer", landscape, f"to scale; squares of {SQUARE} sphere diameters"),
        "profile": Plot("thickness profile", lambda size: profile_plot(profile, size), "along the dashed line"),
    }
