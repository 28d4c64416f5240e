"""What each pass wrote, each lighting term alone, and what can go wrong: the panels of the contact sheet, by name."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View
from fakesss.colour import decode_srgb, to_8bit
from fakesss.contact_sheet import EMPTY, MARK, OTHER, Mark, Panel, Plot, Size
from fakesss.depth_checks import blur_width, depth_precision
from fakesss.hard_edges import FRONT_BOUND, JUMP, HardEdges, hard_edges, layer_breaks
from fakesss.lighting_terms import lighting_term
from fakesss.problem import BadInput, nearest
from fakesss.profile_plot import Profile, profile_plot
from fakesss.relief import relief
from fakesss.renderer import shared_renderer
from fakesss.scene import Scene

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]
Views = dict[str, Panel | Plot]

OPEN = "open share"  # stands for the resource that holds the occlusion, which depends on its method
OCCLUSION = {"baked": "surface", "screen-space": "screen_occlusion"}  # that resource; of the surface the last channel
WITH_OCCLUSION = {"occlusion.enabled": True, "material.ambient": 1, "light.ambient": (1, 1, 1)}
ROWS = (
    ("front", "second", "normals", "depth_gaps", "depth_precision"),
    ("thickness", "blurred_thickness", "softening", "blur_width", "hard_edges"),
    ("occlusion", "ambient", "diffuse", "specular", "backlight"),
    ("picture", "relief", "profile"),
)
DEPTH, THICKNESS, SIGNED = "cividis_r", "magma_r", "berlin"  # near and thin are bright; no change is dark
BITS = (0.0, 23.0)  # of a float32's fraction
SQUARE = 0.1  # sphere diameters: the sides of the squares that the relief stands on
FLOOR = 0.02  # sphere diameters between the relief's board and the farthest point


@dataclass(frozen=True, eq=False)
class Source:
    """What views are made from: a scene and those of its layers that they ask for, (H, W) or (H, W, components)."""

    scene: Scene
    layers: Mapping[str, NDArray[Any]]

    def __getitem__(self, layer: str) -> NDArray[Any]:
        return self.layers[layer]

    @cached_property
    def covered(self) -> Mask:
        """Pixels that show the object."""
        inside: Mask = self["front"] > 0
        return inside

    @cached_property
    def edges(self) -> HardEdges:
        return hard_edges(self["front"], self["thickness"])

    @cached_property
    def thickest(self) -> tuple[float, float]:
        """The scale of both thicknesses, so that the two can be compared."""
        return 0.0, max(float(self["thickness"].max()), 1e-6)


@dataclass(frozen=True)
class Kind:
    """How a view is made: its title, the layers it is made from, and the function that makes it of both."""

    title: str
    reads: tuple[str, ...]
    make: Callable[[str, Source], Panel | Plot]


def views(scene: Scene) -> Views:
    """Every view of `scene` by name, as docs/views.md describes them.

    A panel's `values` are data, (H, W) in the unit of its note, or 8-bit RGB (H, W, 3). All are made, whether or not
    the picture calls for them; `explain` tells which it does.
    """
    names = [name for row in ROWS for name in row]
    source = drawn(scene, names)
    return {name: KINDS[name].make(KINDS[name].title, source) for name in names}


def view(scene: Scene, name: str) -> Panel | Plot:
    """The view called `name` as `views` makes it, at no other view's cost; `BadInput` for a name that is none."""
    if name not in KINDS:
        raise BadInput(f'view "{name}": there is none; {nearest(name, list(KINDS))}')
    return KINDS[name].make(KINDS[name].title, drawn(scene, [name]))


def drawn(scene: Scene, names: Iterable[str]) -> Source:
    """What the views called `names` are made from."""
    asked, targets = layers_of(scene, names)
    return Source(scene, shared_renderer().data(asked, targets) if targets else {})


def layers_of(scene: Scene, names: Iterable[str]) -> tuple[Scene, tuple[str, ...]]:
    """The layers that the views called `names` read, and the scene that they are of: one that calls for them."""
    reads = tuple(dict.fromkeys(layer for name in names for layer in KINDS[name].reads))
    if OPEN not in reads:
        return scene, reads
    found = OCCLUSION[scene.occlusion.method]
    layers = dict.fromkeys(found if layer == OPEN else layer for layer in reads)
    return scene.replace(WITH_OCCLUSION), tuple(layers)


def pixel_width(scene: Scene) -> float:
    """Of a pixel at the sphere's centre, in sphere diameters; a camera inside the sphere sees it from its surface."""
    camera = View.of(scene.camera, scene.size)
    return max(camera.distance, 1.0) * camera.tangent[0] / scene.size[0]


def front(title: str, of: Source) -> Panel:
    return Panel(title, of["front"] - 1, of.covered, "depth into the sphere, radii", DEPTH)


def second(title: str, of: Source) -> Panel:
    return Panel(title, of["second"] - 1, of["second"] > 0, "depth into the sphere, radii", DEPTH)


def normals(title: str, of: Source) -> Panel:
    code = np.where(of.covered[..., None], of["surface"][..., :3] * 0.5 + 0.5, 0.0)
    return Panel(title, to_8bit(decode_srgb(code)), of.covered, "right, up, to the viewer")


def depth_gaps(title: str, of: Source) -> Panel:
    """Where the two layers break."""
    gaps = Mark(layer_breaks(of["second"]), OTHER, "second"), Mark(layer_breaks(of["front"]), MARK, "front")
    note = f"jumps > {FRONT_BOUND} diameters"
    return Panel(title, of["front"] - 1, of.covered, note, "gray_r", None, gaps)


def precision(title: str, of: Source) -> Panel:
    """Where the front layer repeats itself."""
    bits, same = depth_precision(of["front"])
    shared = (Mark(same, MARK, "shared"),)
    equal = f"{same.sum() / max(of.covered.sum(), 1):.1%} share a neighbour's depth"
    return Panel(title, bits, of.covered, equal, "viridis", BITS, shared)


def thickness(title: str, of: Source) -> Panel:
    middle = of.scene.size[1] // 2
    return Panel(title, of["thickness"], of.covered, "sphere diameters", THICKNESS, of.thickest, line=middle)


def softened(title: str, of: Source) -> Panel:
    return Panel(title, of["blurred_thickness"], of.covered, "sphere diameters", THICKNESS, of.thickest)


def softening(title: str, of: Source) -> Panel:
    """What softening changed; the scale ends at the 99.5th percentile, since a few pixels change much more."""
    change = of["blurred_thickness"] - of["thickness"]
    most = max(float(np.percentile(np.abs(change[of.covered]), 99.5)), 1e-4) if of.covered.any() else 1.0
    return Panel(title, change, of.covered, "sphere diameters", SIGNED, (-most, most))


def softened_width(title: str, of: Source) -> Panel:
    width = blur_width(of["second"], of.scene)
    return Panel(title, width, of["second"] > 0, "sphere diameters, on the object", "viridis")


def edges(title: str, of: Source) -> Panel:
    """Where the exact thickness jumps."""
    jumps = f"{of.edges.share:.2%} of pixels, {of.edges.length(pixel_width(of.scene)):.2f} diameters long"
    marked = (Mark(of.edges.mask, MARK, f"jump > {JUMP}"),)
    return Panel(title, of["thickness"], of.covered, jumps, "gray_r", None, marked)


def occlusion(title: str, of: Source) -> Panel:
    found = of[OCCLUSION[of.scene.occlusion.method]]
    open_share = found if found.ndim == 2 else found[..., 3]
    return Panel(title, open_share, of.covered, "share of the hemisphere open", "gray", (0.0, 1.0))


def term(title: str, of: Source) -> Panel:
    """One term of the lighting equation alone."""
    pixels, note = lighting_term(of.scene, title, np.array(EMPTY) / 255)
    return Panel(title, pixels, everywhere(pixels), note)


def picture(title: str, of: Source) -> Panel:
    """What the terms add up to."""
    pixels = to_8bit(shared_renderer().render(of.scene).image[..., :3])
    return Panel(title, pixels, everywhere(pixels), of.scene.object)


def everywhere(pixels: NDArray[np.uint8]) -> Mask:
    return np.ones(pixels.shape[:2], np.bool_)


def landscape(title: str, of: Source) -> Plot:
    """The front layer as a landscape."""
    pixel, depth = pixel_width(of.scene), of["front"].astype(np.float64) / 2
    heights = np.where(of.covered, depth.max(initial=0.0) + FLOOR - depth, 0.0)

    def draw(size: Size) -> NDArray[np.uint8]:
        return relief(heights, of.covered, pixel, size, DEPTH.removesuffix("_r"), SQUARE)

    return Plot(title, draw, f"to scale; squares of {SQUARE} sphere diameters")


def profile(title: str, of: Source) -> Plot:
    """The thickness along the middle row."""
    width, height = of.scene.size
    middle = height // 2
    exact, soft = (
        np.where(of.covered[middle], of[name][middle], np.nan) for name in ("thickness", "blurred_thickness")
    )
    across = (np.arange(width, dtype=np.float64) + 0.5 - width / 2) * pixel_width(of.scene)
    curves = Profile(across, exact, soft, runs(across, of.edges.mask[middle]))
    return Plot(title, lambda size: profile_plot(curves, size), "along the dashed line")


def runs(positions: Float, marked: Mask) -> list[float]:
    """The middle of every run of marked positions, both (W,)."""
    ends = np.flatnonzero(np.diff(marked, prepend=False, append=False))
    return [float(positions[first:last].mean()) for first, last in zip(ends[::2], ends[1::2], strict=True)]


BOTH = ("front", "thickness", "blurred_thickness")
KINDS: Mapping[str, Kind] = {
    "front": Kind("front layer", ("front",), front),
    "second": Kind("second layer", ("second",), second),
    "normals": Kind("normals", ("front", "surface"), normals),
    "depth_gaps": Kind("depth gaps", ("front", "second"), depth_gaps),
    "depth_precision": Kind("precision, bits", ("front",), precision),
    "thickness": Kind("thickness", ("front", "thickness"), thickness),
    "blurred_thickness": Kind("softened thickness", BOTH, softened),
    "softening": Kind("softened - exact", BOTH, softening),
    "blur_width": Kind("width of softening", ("second",), softened_width),
    "hard_edges": Kind("hard edges", ("front", "thickness"), edges),
    "occlusion": Kind("occlusion [a]", ("front", OPEN), occlusion),
    "ambient": Kind("ambient", (), term),
    "diffuse": Kind("diffuse", (), term),
    "specular": Kind("specular", (), term),
    "backlight": Kind("backlight", (), term),
    "picture": Kind("picture", (), picture),
    "relief": Kind("relief of the front layer", ("front",), landscape),
    "profile": Kind("thickness profile", BOTH, profile),
}
"""Every view by name."""
