"""What keeps light from a point, by rays: ambient occlusion at vertices and at points, and shadows of lights.

Occlusion is asked at every sample, not at vertices and interpolated as the bake does; its error is told in
docs/accuracy.md. Shadows are hard, since a light has no size, and what a shadow map's filter softens is part of its
error; but for the filter "disc", which asks for a penumbra: the mean over its disc.
"""

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fakesss import illumination
from fakesss.calls import Setting
from fakesss.camera import View
from fakesss.hemisphere import even_directions, mean_over_hemisphere, weighed
from fakesss.lights import Light
from fakesss.mesh import Mesh
from fakesss.occlusion import CLEARANCE
from fakesss.ray_casting import Caster
from fakesss.scene import Occlusion
from fakesss.screen_occlusion import GOLDEN_ANGLE, frame_around
from fakesss.shadow_maps import REACH

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

DISC_RAYS = 16  # to a light through a penumbra's disc, turned otherwise in each of a pixel's samples
RAYS = 16_384  # a pixel, of occlusion; a vertex, of local thickness
SHADOW_CLEARANCE = 1e-4  # sphere radii, along the normal, from a point to where its rays to the lights start


def point_occlusion(caster: Caster, points: Floats, normals: Floats, settings: Occlusion, rays: int = 4096) -> Floats:
    """Share (M,) of directions around each point in which nothing lies within `occlusion.radius`: 0..1.

    What screen-space occlusion samples, but of the whole object, also of what the camera does not see. `points` and
    unit `normals` (M, 3) in the world frame; rays start 5e-4 radii along the normal.
    """
    radius = np.float32(2 * settings.radius)
    origins, axes = (points + CLEARANCE * normals).astype(np.float32), normals.astype(np.float32)

    def clear(start: NDArray[np.float32], along: NDArray[np.float32], reach: NDArray[np.float32]) -> Mask:
        return caster.clear(start, along, np.minimum(reach, radius))

    mean, _ = mean_over_hemisphere(origins, axes, rays, settings.sampling, clear, "occlusion of points")
    return np.nan_to_num(mean, nan=1.0)


def sample_occlusion(
    caster: Caster, starts: Floats, normals: Floats, numbers: NDArray[np.int64], settings: Occlusion, rays: int
) -> Floats:
    """[a] (M,) of points by `rays` each: within `occlusion.radius` for the screen-space method, else however far.

    Points with one of `numbers` (M,) ask along the same even directions, each number's turned otherwise: with a number
    for each sample in a pixel, all the rays of a pixel are spread over its hemisphere. `starts` and unit `normals`
    (M, 3), world frame; rays start 5e-4 radii along the normal, as those of the bake.
    """
    farthest = np.float32(2 * settings.radius if settings.method == "screen-space" else np.inf)
    origins = (starts + CLEARANCE * normals).astype(np.float32)
    even, mean = even_directions(2 * rays), np.ones(len(starts))

    def clear(start: NDArray[np.float32], along: NDArray[np.float32], reach: NDArray[np.float32]) -> Mask:
        return caster.clear(start, along, np.minimum(reach, farthest))

    def of_number(number: int) -> None:
        own = np.flatnonzero(numbers == number)
        turned = Rotation.from_quat(np.random.default_rng(number).normal(size=4)).apply(even)  # Shoemake 1992
        axes = np.ascontiguousarray(normals[own].T.astype(np.float32))
        total, weight, _ = weighed(origins[own], axes, turned.astype(np.float32), settings.sampling, clear)
        mean[own] = np.divide(total, weight, out=np.ones(len(own)), where=weight > 0)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(of_number, np.unique(numbers)))
    return mean


def onto_smooth_surface(
    mesh: Mesh, faces: NDArray[np.int32], shares: Floats, points: Floats, from_behind: Mask
) -> Floats:
    """Points (M, 3) of flat triangles lifted to the round surface that their vertex normals describe, never below.

    Hanika, *Hacking the shadow terminator* (Ray Tracing Gems II, 2021). Shading uses the smooth normals, so near where
    the light grazes it a point is lit although its triangle, or the next one, already turns away: rays from the flat
    triangle would show the triangles there. Where a surface is seen from behind, its normals are turned.
    """
    turned = np.where(from_behind, -1.0, 1.0)[:, None]
    lifted = np.zeros_like(points)
    for corner in range(3):
        vertices = mesh.faces[faces, corner]
        normal = turned * mesh.normals[vertices]
        below = ((points - mesh.positions[vertices]) * normal).sum(axis=1, keepdims=True)
        lifted += shares[:, [corner]] * (points - np.minimum(below, 0) * normal)
    return lifted


def lit_shares(setting: Setting, caster: Caster, starts: Floats, normals: Floats) -> dict[int, Floats]:
    """For the number of each light that casts shadows, the share of it that the object lets through to a point (M,).

    `starts` and unit `normals` (M, 3), world frame: where rays start is `SHADOW_CLEARANCE` further along the normal.
    Numbers are those of `illumination.lighting`: 0 is `light`, i + 1 `lights.i`.
    """
    scene, view = setting.scene, setting.view
    origins = starts + SHADOW_CLEARANCE * normals
    numbered = enumerate((scene.light, *scene.lights))
    if scene.shadow.filter != "disc":
        return {number: reaches(one, view, caster, origins) for number, one in numbered if one in setting.casting}
    radius = 2 * scene.shadow.radius
    return {
        number: np.mean([reaches(one, view, caster, tap) for tap in disc(one, view, origins, normals, radius)], axis=0)
        for number, one in numbered
        if one in setting.casting
    }


def disc(light: Light, view: View, origins: Floats, normals: Floats, radius: float) -> Iterator[Floats]:
    """Points (M, 3) of a disc around each of `origins` that faces the light: its penumbra is the mean over them.

    As in `glsl/common_shadow.glsl` a point may hide nothing from itself: where the surface's own plane lies nearer to
    the light than the disc, the plane is taken, up to `shadow_maps.REACH`.
    """
    to_light = illumination.arriving(light, view, view.turn(origins))[0] @ view.rotation
    across = frame_around(to_light)
    n_dot_l = np.maximum((normals * to_light).sum(axis=1), 1e-6)
    turn = GOLDEN_ANGLE * DISC_RAYS * np.arange(len(origins))
    for k in range(DISC_RAYS):  # Vogel 1979, as the filter
        angle, distance = turn + GOLDEN_ANGLE * k, radius * np.sqrt((k + 0.5) / DISC_RAYS)
        aside = distance * (np.cos(angle)[:, None] * across[0] + np.sin(angle)[:, None] * across[1])
        nearer = np.clip(-(aside * normals).sum(axis=1) / n_dot_l, 0, REACH)
        yield origins + aside + nearer[:, None] * to_light


def reaches(light: Light, view: View, caster: Caster, origins: Floats) -> Floats:
    """Whether a light is seen from `origins` (M, 3), world frame: 1 or 0, (M,)."""
    place = illumination.place(light, view)
    to_light, _ = illumination.arriving(light, view, view.turn(origins))
    far = np.linalg.norm(place[:3] - view.turn(origins), axis=1) if place[3] else np.full(len(origins), np.inf)
    directions = (to_light @ view.rotation).astype(np.float32)
    return caster.clear(origins.astype(np.float32), directions, far.astype(np.float32)).astype(np.float64)
