"""Where the object is in the picture, and how much of the background shines through it unscattered: exact, by rays."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fakesss import cache
from fakesss.camera import View
from fakesss.crossings import Crossings, paths
from fakesss.mesh import Mesh
from fakesss.reference import camera_rays

Floats = NDArray[np.float64]

VERSION = 1  # raised whenever the values change, so that cached ones are made again
SIDE = 4  # rays a pixel: SIDE x SIDE on a grid
BAND = 1 << 18  # rays at once


@dataclass(frozen=True)
class Silhouette:
    """Means over the pixels' areas."""

    coverage: Floats  # (H, W), 0..1, by the object's outline however thin the medium is
    through: Floats  # (H, W, 3), 0..1: light from behind that meets the object and passes it unscattered


def silhouette(mesh: Mesh, view: View, size: tuple[int, int], extinction: Floats | None) -> Silhouette:
    """What a camera sees of a mesh whose medium takes `extinction` (3,) per radius; None: nothing shines through.

    Kept in the cache.
    """
    shape = (size[1], size[0])
    numbers = None if extinction is None else extinction.tolist()
    place = [view.rotation.tolist(), view.distance, view.tangent]
    key = {"version": VERSION, "mesh": mesh.sha256, "view": place, "size": size, "extinction": numbers, "side": SIDE}
    found, _ = cache.cached(
        "silhouette", key, {"coverage": shape, "through": (*shape, 3)}, lambda: cast(mesh, view, size, extinction)
    )
    return Silhouette(found["coverage"], found["through"])


def cast(mesh: Mesh, view: View, size: tuple[int, int], extinction: Floats | None) -> cache.Arrays:
    """The arrays of a `Silhouette`. A ray that leaves as often as it enters lets exp(-extinction way) through."""
    crossings = Crossings(mesh)
    origins, directions = camera_rays(view, (size[0] * SIDE, size[1] * SIDE))
    hit, through = np.zeros(len(origins)), np.zeros((len(origins), 3))
    for start in range(0, len(origins), BAND):
        band = slice(start, start + BAND)
        hits = crossings(origins[band], directions[band], most=1 if extinction is None else 64)
        met = np.flatnonzero((hits.sides != 0).any(axis=1))
        hit[start + met] = 1
        if extinction is not None and len(met):
            way = np.maximum(np.nan_to_num(paths(hits, hits.distances)[met], nan=np.inf), 0)
            through[start + met] = np.exp(-extinction * way[:, None])
    return {"coverage": pixel_means(hit[:, None], size)[..., 0], "through": pixel_means(through, size)}


def pixel_means(values: Floats, size: tuple[int, int]) -> Floats:
    """(H, W, K) of values (H SIDE W SIDE, K)."""
    width, height = size
    means: Floats = values.reshape(height, SIDE, width, SIDE, -1).mean(axis=(1, 3))
    return means
