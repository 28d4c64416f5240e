"""Rays against a mesh through Embree (Wald et al., *Embree: a kernel framework*, 2014), as its binding takes them.

Rays are (N, 3) float32 origins and directions; one direction, (1, 3), serves all origins. `reach` (N,) float32 is how
far each ray looks, in lengths of its direction, infinity included. A ray of negative reach is passed over at next to no
cost; what is answered for it means nothing.
"""

import time
from typing import Any

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

from fakesss.mesh import Mesh

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

NOTHING = -1


class Caster:
    """A mesh's bounding-volume hierarchy; safe to use from threads, which Embree serves side by side."""

    def __init__(self, mesh: Mesh) -> None:
        started = time.perf_counter()
        self._scene = EmbreeScene()
        # Embree reads the arrays where they lie, so they must live as long as the scene
        self._vertices = np.ascontiguousarray(mesh.positions)
        self._faces = np.ascontiguousarray(mesh.faces)
        self._geometry = TriangleMesh(self._scene, self._vertices, self._faces)
        # the first query builds the hierarchy, which two threads must not do at once
        self.first_face(np.zeros((1, 3), np.float32), np.ones((1, 3), np.float32))
        self.build_seconds = time.perf_counter() - started

    def first_face(
        self, origins: NDArray[Any], directions: NDArray[Any], reach: NDArray[Any] | None = None
    ) -> NDArray[np.int32]:
        """The index of the first triangle that each ray hits within its reach, or `NOTHING`."""
        far = None if reach is None else reach.astype(np.float32)
        rays = origins.astype(np.float32, copy=False), directions.astype(np.float32, copy=False)
        found: NDArray[np.int32] = self._scene.run(*rays, dists=far, query="INTERSECT")
        return found

    def clear(self, origins: Floats32, directions: Floats32, reach: Floats32) -> NDArray[np.bool_]:
        """Whether each ray hits nothing within its reach."""
        found: NDArray[np.int32] = self._scene.run(origins, directions, dists=reach, query="OCCLUDED")
        clear: NDArray[np.bool_] = found == NOTHING
        return clear

    def distance(self, origins: Floats32, directions: Floats32, reach: Floats32) -> Floats32:
        """How far each ray goes before it hits something; its reach where it hits nothing."""
        # Embree writes the answers over the reaches
        found: Floats32 = self._scene.run(origins, directions, dists=reach.copy(), query="DISTANCE")
        return found
