"""Closed meshes on which it is known where the thickness jumps."""

from pathlib import Path

import numpy as np
import trimesh

from fakesss import solids

HOLLOW = 0.8  # radius of the hollow ball's cavity, in radii of the ball


def step_file(folder: Path) -> str:
    """A block with a flat face to the viewer that is 0.6 deep on the left and 0.2 on the right of x = 0."""
    outline = [(-1, -0.3), (0, -0.3), (0, 0.1), (1, 0.1), (1, 0.3), (-1, 0.3)]  # x, z
    n = len(outline)
    points = [(x, y, z) for y in (-0.5, 0.5) for x, z in outline]
    sides = [(i, (i + 1) % n, n + i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    caps = [(0, 1, 5), (1, 2, 5), (2, 3, 4), (2, 4, 5)]
    faces = [*np.reshape(sides, (-1, 3)), *caps, *(np.array(caps)[:, ::-1] + n)]
    solid = trimesh.Trimesh(points, faces, process=False)
    solid.fix_normals()
    assert solid.is_watertight
    solid.export(folder / "step.ply")
    return str(folder / "step.ply")


def hollow_ball_file(folder: Path) -> str:
    """A ball with a concentric cavity of `HOLLOW` radii: seen from anywhere its thickness jumps on a circle."""
    positions, _, faces = solids.sphere(20_000)
    inner = np.asarray(faces)[:, ::-1] + len(positions)
    trimesh.Trimesh(
        np.concatenate([positions, HOLLOW * positions]), np.concatenate([faces, inner]), process=False
    ).export(folder / "hollow.ply")
    return str(folder / "hollow.ply")
