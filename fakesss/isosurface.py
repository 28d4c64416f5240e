"""From a distance field to a closed mesh of about so many triangles.

Marching cubes (Lewiner et al. 2003, scikit-image) on blocks near the surface, triangles evened out by sliding vertices
along the surface, vertices put on the zero set by Newton steps, normals from the field's gradient. Coarse meshes are
simplified from a fine one (Garland and Heckbert 1997), since a coarse grid would lose the thin parts.
"""

import os
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import fast_simplification
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from skimage.measure import marching_cubes

from fakesss.distance import Distance
from fakesss.vertex_normals import normalised

Floats = NDArray[np.float64]
Indices = NDArray[np.integer[Any]]
Box = tuple[tuple[float, float, float], tuple[float, float, float]]

BLOCK = 8  # cells a side; the unit of what is evaluated or skipped
CHUNK = 32768  # points evaluated at once, so that temporaries stay in the cache
FINE_FACES = 120_000  # fewest triangles cut from the grid; coarser meshes are simplified from these


def evaluate(field: Distance, points: Floats) -> Floats:
    """`field` at (N, 3) points, in chunks on all cores."""
    chunks = np.array_split(points, max(1, -(-len(points) // CHUNK)))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return np.concatenate(list(pool.map(field, chunks)))


def fine_surface(field: Distance, box: Box, faces: int) -> tuple[Floats, Indices]:
    """Positions (V, 3) and triangles (F, 3) of the zero set inside `box`; F within 4% of `faces`, outwards wound."""
    step = float(np.max(np.subtract(box[1], box[0]))) / 64
    _, triangles = cut(field, box, step)
    # the number of triangles goes with 1/step^2, the better the finer
    for _ in range(3):
        step *= float(np.sqrt(len(triangles) / faces))
        vertices, triangles = cut(field, box, step)
        if abs(len(triangles) / faces - 1) < 0.04:
            break
    return settled(field, vertices, triangles, step), triangles


def simplified(field: Distance, vertices: Floats, triangles: Indices, faces: int) -> tuple[Floats, Indices]:
    """`faces` triangles spread over a fine surface by need: small where it bends or is thin."""
    if faces >= len(triangles):
        return vertices, triangles
    vertices, triangles = fast_simplification.simplify(vertices, triangles, target_count=faces, lossless=False)
    return on_zero_set(field, vertices.astype(float), typical_edge(vertices, triangles), 2), triangles


def field_normals(field: Distance, vertices: Floats, triangles: Indices) -> Floats:
    """Unit normals (V, 3): the direction in which the field rises."""
    return normalised(gradient(field, vertices, typical_edge(vertices, triangles)))


def typical_edge(vertices: Floats, triangles: Indices) -> float:
    """The median length of the triangles' sides."""
    sides = vertices[triangles] - vertices[np.roll(triangles, 1, axis=1)]
    return float(np.median(np.sqrt((sides**2).sum(axis=2))))


def cut(field: Distance, box: Box, step: float) -> tuple[Floats, Indices]:
    """Marching cubes over a grid of spacing `step`, evaluated only in blocks that the surface can reach."""
    low = np.array(box[0]) - 2 * step
    blocks = np.ceil((np.array(box[1]) + 2 * step - low) / (BLOCK * step)).astype(int)
    corner = np.stack(np.meshgrid(*(np.arange(n) for n in blocks), indexing="ij"), axis=-1).reshape(-1, 3)
    middle = evaluate(field, low + (corner * BLOCK + (BLOCK - 1) / 2) * step)
    # half a block's diagonal, and half as much again because the fields are distances to first order only
    near = np.abs(middle) < 1.5 * np.sqrt(3) * BLOCK / 2 * step
    volume = np.repeat(np.sign(middle), BLOCK**3).astype(np.float32).reshape(-1, BLOCK, BLOCK, BLOCK)
    cell = np.stack(np.meshgrid(*(np.arange(BLOCK),) * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    points = low + (corner[near][:, None] * BLOCK + cell) * step
    volume[near] = (evaluate(field, points.reshape(-1, 3)) / step).reshape(-1, BLOCK, BLOCK, BLOCK)
    grid = volume.reshape(*blocks, BLOCK, BLOCK, BLOCK).transpose(0, 3, 1, 4, 2, 5).reshape(*(blocks * BLOCK))
    vertices, triangles, _, _ = marching_cubes(grid, 0.0, gradient_direction="descent", allow_degenerate=False)
    return low + vertices.astype(float) * step, triangles


def gradient(field: Distance, points: Floats, step: float) -> Floats:
    """The field's gradient (N, 3) by differences over the corners of a small tetrahedron."""
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], float)
    reach = 0.05 * step
    values = evaluate(field, (points[:, None] + corners * reach).reshape(-1, 3)).reshape(-1, 4)
    # not by BLAS, whose order of summation may differ between machines
    slope: Floats = np.einsum("ij,jk->ik", values, corners) / (4 * reach)
    return slope


def on_zero_set(field: Distance, points: Floats, step: float, rounds: int) -> Floats:
    """Points moved onto the zero set by Newton steps along the gradient, none longer than half of `step`."""
    for _ in range(rounds):
        slope = gradient(field, points, step)
        steepness = np.maximum((slope**2).sum(axis=1), 0.05)
        move = slope * (evaluate(field, points) / steepness)[:, None]
        length = np.sqrt((move**2).sum(axis=1))
        points = points - move * np.minimum(1, 0.5 * step / np.maximum(length, 1e-12))[:, None]
    return points


def settled(field: Distance, vertices: Floats, triangles: Indices, step: float) -> Floats:
    """Vertices slid towards their neighbours' mean along the surface, which evens out marching cubes' slivers."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    ones = np.ones(len(ends))
    graph = coo_array((ones, (ends[:, 0], ends[:, 1])), shape=(len(vertices),) * 2).tocsr()
    degree = np.maximum(np.asarray(graph.sum(axis=1)).ravel(), 1)
    for _ in range(2):
        normals = normalised(gradient(field, vertices, step))
        for _ in range(4):
            pull = (graph @ vertices) / degree[:, None] - vertices
            vertices = vertices + 0.5 * (pull - normals * (pull * normals).sum(axis=1, keepdims=True))
        vertices = on_zero_set(field, vertices, step, 1)
    return on_zero_set(field, vertices, step, 1)
