"""Baked ambient occlusion: for each vertex the share of rays over its normal's hemisphere that hit nothing.

Gascons, *Fast simulation of translucent objects* (2011), section 3.1. All vertices ask along one fixed set of
directions, spread evenly over the sphere, of which about `rays` lie above any vertex. Neighbours thus ask the same
question: what error is left varies smoothly over the surface. A set turned at random for each vertex has the same
error, but shows as speckle.
"""

import os
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from fakesss import cache
from fakesss.mesh import Mesh

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Sampling = Literal["cosine", "uniform"]

VERSION = 2  # raised whenever the values change, so that cached ones are made again
CLEARANCE = 5e-4  # from the vertex to where its rays start, in sphere radii: clear of the triangles around it
GROUPS = 32  # of directions; sums are taken in this order, whatever the number of threads


@dataclass(frozen=True, eq=False)
class Baked:
    """Occlusion of one mesh, and what it took to get it this time."""

    values: Floats32  # (V,) in 0..1; 1 sees the whole hemisphere
    rays: int  # asked for, per vertex
    rays_cast: int  # in all; 0 when the values came from the cache
    seconds: float  # hierarchy and rays, or reading the cache
    cached: bool


def bake_occlusion(mesh: Mesh, rays: int = 320, sampling: Sampling = "cosine") -> Baked:
    """Ambient occlusion of `mesh`, from the cache where it was baked before.

    "cosine" weights each ray with the cosine to the normal, as irradiance does; "uniform" counts all alike.
    """
    started = time.perf_counter()
    cast = 0

    def make() -> cache.Arrays:
        nonlocal cast
        values, cast = cast_rays(mesh, rays, sampling)
        return {"values": values}

    key = {"version": VERSION, "mesh": mesh.sha256, "rays": rays, "sampling": sampling}
    arrays, cached = cache.cached("occlusion", key, {"values": (len(mesh.positions),)}, make)
    return Baked(arrays["values"], rays, cast, time.perf_counter() - started, cached)


def even_directions(number: int) -> Floats:
    """Unit vectors (number, 3) spread evenly over the sphere: the Fibonacci lattice (Swinbank and Purser, 2006)."""
    index = np.arange(number)
    z = 1 - (2 * index + 1) / number
    angle = index * np.pi * (3 - np.sqrt(5))
    across = np.sqrt(1 - z * z)
    return np.stack([across * np.cos(angle), across * np.sin(angle), z], axis=1)


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
    origins = ray_origins(mesh)
    directions = even_directions(2 * rays).astype(np.float32)
    bar = tqdm(total=len(directions) * len(origins) // 2, unit="ray", unit_scale=True, desc="occlusion", disable=None)

    def share(group: NDArray[np.float32]) -> tuple[Floats, Floats, int]:
        free, asked, cast = np.zeros(len(origins)), np.zeros(len(origins)), 0
        for direction in group:
            cosine = np.einsum("ij,j->i", mesh.normals, direction)
            above = np.flatnonzero(cosine > 0)
            weight = cosine[above] if sampling == "cosine" else np.ones(len(above), np.float32)
            along = np.tile(direction, (len(above), 1))
            asked[above] += weight
            free[above] += weight * ~caster.blocked(origins[above], along)
            cast += len(above)
            bar.update(len(above))
        return free, asked, cast

    with bar, ThreadPoolExecutor(os.cpu_count()) as pool:
        groups = list(pool.map(share, np.array_split(directions, GROUPS)))
    free = np.sum([group[0] for group in groups], axis=0)
    asked = np.sum([group[1] for group in groups], axis=0)
    # with very few rays a vertex may have none above it: nothing was seen to block it
    values = np.divide(free, asked, out=np.ones(len(origins)), where=asked > 0)
    return values.astype(np.float32), sum(group[2] for group in groups)
