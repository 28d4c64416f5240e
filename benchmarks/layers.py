"""Hard edges by kind of thickness, and the error of a coarser second layer: `python benchmarks/layers.py`.

The tables of docs/technique.md.
"""

import numpy as np

from fakesss.camera import View
from fakesss.colour import to_8bit
from fakesss.hard_edges import hard_edges
from fakesss.renderer import shared_renderer
from fakesss.scene import Scene

OBJECTS = ("shell", "head", "hand", "relief", "figure", "knot")
KINDS = ("first-interval", "bridged", "total-path")
SIZES = (512, 1024)
COARSE = (4_000, 8_000, 16_000)


def edges(name: str, kind: str, size: int) -> str:
    """Share of the pixels off the silhouette beside a hard edge, and the length of all, sphere diameters."""
    scene = Scene(object=name, size=(size, size)).replace(
        {"camera.azimuth": 25.0, "camera.elevation": 20.0, "material.thickness": kind}
    )
    view = View.of(scene.camera, scene.size)
    data = shared_renderer().data(scene, ("front", "thickness"))
    found = hard_edges(data["front"], data["thickness"])
    return f"{found.share:.2%} {found.length(view.tangent[0] * view.distance / size):.2f}"


def error(name: str, faces: int) -> str:
    """Covered pixels off by more than 2/255, 99th percentile and maximum, 60K faces against `faces`."""
    scene = Scene(object=f"{name}:60000")
    pictures = [shared_renderer().render(s).image for s in (scene, scene.replace({"layers.faces": faces}))]
    codes = [to_8bit(picture[..., :3]).astype(int) for picture in pictures]
    off = np.abs(codes[0] - codes[1]).max(axis=2)[pictures[0][..., 3] > 0]
    return f"{(off > 2).mean():.1%} {np.percentile(off, 99):.0f} {off.max()}"


def main() -> None:
    """Print both tables."""
    print("hard edges: share, length in diameters;", ", ".join(f"{kind} at {SIZES}" for kind in KINDS))
    for name in OBJECTS:
        print(f"{name:8}", " | ".join(edges(name, kind, size) for kind in KINDS for size in SIZES), flush=True)
    print("coarser second layer: share > 2/255, 99th percentile, largest; from", COARSE)
    for name in OBJECTS[1:]:
        print(f"{name:8}", " | ".join(error(name, faces) for faces in COARSE), flush=True)


if __name__ == "__main__":
    main()
