"""Baked ambient occlusion: for each vertex the share of rays over its normal's hemisphere that hit nothing.

Gascons, *Fast simulation of translucent objects* (2011), section 3.1.
"""

import numpy as np
from numpy.typing import NDArray

from fakesss.baking import Baked, baked
from fakesss.hemisphere import Sampling, mean_over_hemisphere
from fakesss.mesh import Mesh

Floats32 = NDArray[np.float32]

VERSION = 3  # raised whenever the values change, so that cached ones are made again
CLEARANCE = 5e-4  # from the vertex to where its rays start, in sphere radii: clear of the triangles around it


def bake_occlusion(mesh: Mesh, rays: int = 320, sampling: Sampling = "cosine") -> Baked:
    """Ambient occlusion of `mesh`, 0..1 where 1 sees the whole hemisphere; from the cache where it was baked before.

    "cosine" weights each ray with the cosine to the normal, as irradiance does; "uniform" counts all alike.
    """
    depends = {"version": VERSION, "sampling": sampling}
    return baked("occlusion", mesh, rays, depends, lambda: cast_rays(mesh, rays, sampling))


def ray_origins(mesh: Mesh) -> Floats32:
    """Where each vertex's rays start (V, 3): clear of the surface, and drawn from a border or a crease inwards.

    Without the second, a vertex in the corner of a room starts on the next wall and looks through it.
    """
    corners = mesh.positions[mesh.faces].astype(np.float64)
    middle = corners.mean(axis=1)
    inward = np.zeros(mesh.positions.shape)
    for axis in range(3):
        pull = np.repeat(middle[:, axis], 3) - corners[:, :, axis].ravel()
        inward[:, axis] = np.bincount(mesh.faces.ravel(), pull, len(inward))
    triangles = np.maximum(np.bincount(mesh.faces.ravel(), minlength=len(inward)), 1)
    inward /= triangles[:, None]
    # along the surface only: on a curved one the neighbours lie below the vertex
    inward -= mesh.normals * (inward * mesh.normals).sum(axis=1, keepdims=True)
    length = np.sqrt((inward**2).sum(axis=1, keepdims=True))
    inward *= np.minimum(0.1, CLEARANCE / np.maximum(length, 1e-12))
    return (mesh.positions + CLEARANCE * mesh.normals + inward).astype(np.float32)


def cast_rays(mesh: Mesh, rays: int, sampling: Sampling) -> tuple[Floats32, int]:
    """Occlusion values (V,) in 0..1 and the number of rays cast."""
    from fakesss.ray_casting import Caster  # Embree is needed only where nothing is cached

    caster = Caster(mesh)
    mean, cast = mean_over_hemisphere(ray_origins(mesh), mesh.normals, rays, sampling, caster.clear, "occlusion")
    # with very few rays a vertex may have none above it: nothing was seen to block it
    return np.nan_to_num(mean, nan=1.0).astype(np.float32), cast
