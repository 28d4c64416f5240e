"""Baked local thickness: for each vertex the mean distance into the object before a ray meets a surface.

Barre-Brisebois and Bouchard, *Approximating translucency for a fast, cheap and convincing subsurface scattering look*
(GDC 2011): ambient occlusion with inverted normals. Here it is a length, not a share of rays: the mean, weighted with
the cosine to the inverted normal, of the distance to the first surface, whichever way it faces. A distance beyond
`reach` counts as `reach`. A ray that meets nothing has left through an opening or run along a sheet, where there is no
matter, and counts 0; `open_surface` concerns layers of a picture and changes nothing here.

It is not the thickness along the view: it changes neither with the camera nor with the light, and is known at vertices
only. Over a closed surface without clipping its mean is 4 V / S, of volume V and area S (Cauchy's mean chord).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from fakesss.baking import Baked, baked
from fakesss.hemisphere import mean_over_hemisphere
from fakesss.mesh import Mesh
from fakesss.vertex_normals import face_normals

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
FirstFace = Callable[[Floats32, Floats32], NDArray[np.int32]]  # as `Caster.first_face`

VERSION = 2  # raised whenever the values change, so that cached ones are made again
CLEARANCES = (5e-5, 5e-6, 5e-7)  # from the vertex to where its rays start, in sphere radii; the last is 8 roundings
LONGEST = np.float32(4)  # sphere radii; two points of the object are at most 2 apart


def bake_local_thickness(mesh: Mesh, rays: int = 320, reach: float = 0.5) -> Baked:
    """Local thickness of `mesh`, 0..`reach` in sphere diameters; from the cache where it was baked before."""
    depends = {"version": VERSION, "reach": reach}
    return baked("local_thickness", mesh, rays, depends, lambda: cast_inwards(mesh, rays, reach))


def cast_inwards(mesh: Mesh, rays: int, reach: float) -> tuple[Floats32, int]:
    """Local thickness (V,) in sphere diameters and the number of rays cast."""
    from fakesss.ray_casting import Caster  # Embree is needed only where nothing is cached

    caster = Caster(mesh)
    most = np.float32(2 * reach)

    def length(origins: Floats32, direction: Floats32, limit: Floats32) -> Floats32:
        distance = caster.distance(origins, direction, limit)
        return np.where(distance < LONGEST, np.minimum(distance, most), np.float32(0))

    origins, inside = inner_origins(mesh, caster.first_face)
    mean, cast = mean_over_hemisphere(origins, -mesh.normals, rays, "cosine", length, "local thickness")
    # with very few rays a vertex may have none below it
    values = np.nan_to_num(mean) / 2
    values[~inside] = mean_of_neighbours(mesh, values, inside)[~inside]
    return values.astype(np.float32), cast


def mean_of_neighbours(mesh: Mesh, values: Floats, known: NDArray[np.bool_]) -> Floats:
    """For each vertex the mean of `values` (V,) over those of its neighbours that are `known` (V,), 0 without any.

    Where a surface runs through itself at a vertex it has no inside, and 0 would show as a spot.
    """
    total, count = np.zeros(len(values)), np.zeros(len(values))
    for corner, other in ((0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2)):
        here, there = mesh.faces[:, corner], mesh.faces[:, other]
        total += np.bincount(here, values[there] * known[there], len(values))
        count += np.bincount(here, known[there], len(values))
    return np.divide(total, count, out=np.zeros(len(values)), where=count > 0)


def inner_origins(mesh: Mesh, first_face: FirstFace) -> tuple[Floats32, NDArray[np.bool_]]:
    """Where each vertex's rays start (V, 3), and whether that lies inside (V,): just under one of its own triangles.

    The vertex normal would not do: where triangles are crumpled it may point out of the object both ways. The largest
    of `CLEARANCES` that stays inside is taken, since a plate may be thinner than it: the way back to the triangle first
    meets a surface from behind. None does at the edge of a knife, where a surface runs through itself, or without one.
    """
    own, towards = own_triangles(mesh)
    normals = face_normals(mesh.positions, mesh.faces)
    length = np.sqrt((towards**2).sum(axis=1, keepdims=True))
    origins = mesh.positions.copy()
    inside = np.zeros(len(origins), bool)
    for clearance in CLEARANCES:
        left = np.flatnonzero(~inside & (own >= 0))
        aside = towards[left] * np.minimum(0.1, clearance / np.maximum(length[left], 1e-12))
        start = (mesh.positions[left] + aside - clearance * normals[own[left]]).astype(np.float32)
        back = normals[own[left]]
        face = first_face(start, back.astype(np.float32))
        found = (face >= 0) & ((normals[face] * back).sum(axis=1) > 0)
        origins[left[found]], inside[left[found]] = start[found], True
    return origins, inside


def own_triangles(mesh: Mesh) -> tuple[NDArray[np.int64], Floats]:
    """For each vertex its largest triangle (V,), -1 where it has none, and the way to that one's middle (V, 3)."""
    corners = mesh.positions[mesh.faces].astype(np.float64)
    area = (np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) ** 2).sum(axis=1)
    own = np.full(len(mesh.positions), -1)
    by_area = np.argsort(area, kind="stable")
    own[mesh.faces[by_area]] = by_area[:, None]  # the last one written stays
    return own, corners.mean(axis=1)[own] - mesh.positions
