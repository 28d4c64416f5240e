"""Values at vertices that rays are cast for: kept by what they depend on, and told what they took."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss import cache
from fakesss.mesh import Mesh

Floats32 = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Baked:
    """Values of one mesh, and what it took to get them this time."""

    values: Floats32  # (V,), in the unit of what was baked
    rays: int  # asked for, per vertex
    rays_cast: int  # in all; 0 when the values came from the cache
    seconds: float  # hierarchy and rays, or reading the cache
    cached: bool


def baked(
    kind: str, mesh: Mesh, rays: int, depends: Mapping[str, Any], cast: Callable[[], tuple[Floats32, int]]
) -> Baked:
    """The values of `cast()`, which also counts its rays, or those kept under `kind` for equal mesh and settings.

    `depends` is all that they depend on beside mesh and rays, the algorithm's version among it.
    """
    started = time.perf_counter()
    rays_cast = 0

    def make() -> cache.Arrays:
        nonlocal rays_cast
        values, rays_cast = cast()
        return {"values": values}

    key = {"mesh": mesh.sha256, "rays": rays, **depends}
    arrays, cached = cache.cached(kind, key, {"values": (len(mesh.positions),)}, make)
    return Baked(arrays["values"], rays, rays_cast, time.perf_counter() - started, cached)
