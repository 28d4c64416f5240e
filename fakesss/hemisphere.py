"""What vertices learn from rays over a hemisphere: one fixed set of directions, weighed alike, cast on all cores.

All vertices ask along the same directions, spread evenly over the sphere, of which half lie above any vertex.
Neighbours thus ask the same question: what error is left varies smoothly over the surface. A set turned at random for
each vertex has the same error, but shows as speckle.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from fakesss.patience import Unwanted, is_wanted
from fakesss.space_order import along_curve

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Sampling = Literal["cosine", "uniform"]

# (N, 3) origins, one direction (1, 3), reaches (N,) as `ray_casting` takes them, which it may write over: what each
# ray counts, (N,), finite
Answer = Callable[[Floats32, Floats32, Floats32], NDArray[Any]]

BLOCK = 2048  # vertices that go along one direction together: many enough that a call costs little beside its rays
SHARES = 32  # of the directions, so that there is work for many cores even on a small mesh
TOGETHER = 20  # directions at once: their weights stay in cache, and sums of so few are exact enough in float32
FARTHER = np.float32(1e30)  # times the cosine is a reach beyond everything above the horizon, and negative below


def even_directions(number: int) -> Floats:
    """Unit vectors (number, 3) spread evenly over the sphere: the Fibonacci lattice (Swinbank and Purser, 2006)."""
    index = np.arange(number)
    z = 1 - (2 * index + 1) / number
    angle = index * np.pi * (3 - np.sqrt(5))
    across = np.sqrt(1 - z * z)
    return np.stack([across * np.cos(angle), across * np.sin(angle), z], axis=1)


def mean_over_hemisphere(
    origins: Floats32, axes: Floats32, rays: int, sampling: Sampling, answer: Answer, label: str
) -> tuple[Floats, int]:
    """The mean of `answer` over the directions above each origin (V,), NaN where there is none; and the rays cast.

    `axes` (V, 3), unit length, say where above is. Of `2 * rays` directions about `rays` lie there. "cosine" weighs
    each with the cosine to the axis, "uniform" counts all alike. `label` names the work in the progress bar.
    Sums are taken in the same order whatever the number of threads, so equal input gives equal bytes. Raises
    `patience.Unwanted` when nobody waits for it any more.
    """
    order = along_curve(origins)
    near, normals = origins[order], np.ascontiguousarray(axes[order].T)
    directions = even_directions(2 * rays).astype(np.float32)
    blocks = [slice(start, start + BLOCK) for start in range(0, len(order), BLOCK)]
    shares = np.array_split(directions, min(SHARES, len(directions)))
    total, weight, cast = np.zeros(len(order)), np.zeros(len(order)), 0
    bar = tqdm(total=rays * len(order), unit="ray", unit_scale=True, desc=label, disable=None)
    with bar, ThreadPoolExecutor(os.cpu_count()) as pool:
        work = [(block, share) for block in blocks for share in shares]
        sums = pool.map(lambda item: weighed(near[item[0]], normals[:, item[0]], item[1], sampling, answer), work)
        for (block, _), (of_block, weight_of_block, asked) in zip(work, sums, strict=True):
            total[block] += of_block
            weight[block] += weight_of_block
            cast += asked
            bar.update(asked)
            if not is_wanted():
                pool.shutdown(cancel_futures=True)
                raise Unwanted(label)
    mean = np.full(len(order), np.nan)
    mean[order] = np.divide(total, weight, out=np.full(len(order), np.nan), where=weight > 0)
    return mean, cast


def weighed(
    origins: Floats32, axes: Floats32, directions: Floats32, sampling: Sampling, answer: Answer
) -> tuple[Floats, Floats, int]:
    """Sums over `directions` of weight times answer, and of weight, for each origin (N,); and the rays cast.

    `axes` is (3, N). All origins go along one direction together, those below it passed over: rays alike meet the same
    triangles, and nothing is gathered or scattered.
    """
    total, weights, cast = np.zeros(len(origins)), np.zeros(len(origins)), 0
    buffers = np.empty((2, TOGETHER, len(origins)), np.float32)  # reused: fresh memory costs as much as the arithmetic
    for some in np.array_split(directions, -(-len(directions) // TOGETHER)):
        cosine, ray = buffers[:, : len(some)]
        x, y, z = some.T[:, :, None]
        # a matrix product would round differently from block to block
        np.multiply(x, axes[0], out=cosine)
        for component, axis in ((y, axes[1]), (z, axes[2])):
            cosine += np.multiply(component, axis, out=ray)
        np.multiply(cosine, FARTHER, out=ray)
        weight = np.maximum(cosine, 0, out=cosine)
        if sampling == "uniform":
            np.sign(weight, out=weight)
        weights += weight.sum(axis=0)
        cast += int(np.count_nonzero(weight))
        for reach, direction in zip(ray, some, strict=True):
            reach[:] = answer(origins, direction[None], reach)
        total += np.multiply(weight, ray, out=ray).sum(axis=0)
    return total, weights, cast
