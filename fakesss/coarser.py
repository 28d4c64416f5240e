"""A surface with fewer faces, for what may be approximate. Garland and Heckbert, *Surface simplification using quadric
error metrics*, 1997, as the library fast-simplification does it."""

import fast_simplification
import numpy as np

from fakesss import mesh_repair
from fakesss.mesh import Mesh
from fakesss.vertex_normals import with_creases


def coarser(mesh: Mesh, faces: int) -> Mesh:
    """`mesh` in about `faces` faces, in the same place; the same one if it has no more.

    Vertices that creases had split are one again, so that the simplifier opens no seams.
    """
    if faces >= len(mesh.faces):
        return mesh
    positions, triangles = mesh_repair.weld(mesh.positions.astype(np.float64), mesh.faces, [])
    few, triangles = fast_simplification.simplify(positions, triangles, target_count=faces, lossless=False)
    kept, triangles = mesh_repair.weld(few.astype(np.float64), triangles.astype(np.int64), [])
    watertight = mesh_repair.is_closed(triangles)
    single, normals, triangles = with_creases(kept, triangles)
    return Mesh(single, normals, triangles, watertight, (), mesh.centre, mesh.radius)
