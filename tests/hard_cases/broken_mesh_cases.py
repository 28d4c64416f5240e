"""Hard cases that are damaged mesh files, drawn or refused."""

import hard_meshes as make
import numpy as np
from hard_case import Case
from hard_meshes import glb, obj, ply, stl

ASKEW = {"camera.azimuth": 25.0, "camera.elevation": 20.0}

DAMAGED = [
    Case(
        "zero-area-triangles",
        "A third of the triangles is cut, and triangles without area close the gaps.",
        "The ball; dropping them would open it.",
        lambda: obj(make.with_slivers(make.ball())),
        ".obj",
    ),
    Case(
        "duplicate-triangles",
        "Every triangle is there three times.",
        "The ball, and a sentence that copies were dropped.",
        lambda: ply((make.ball()[0], np.tile(make.ball()[1], (3, 1)))),
        ".ply",
    ),
    Case(
        "unused-broken-vertices",
        "NaN, infinity and a point 1e300 away, which no triangle uses.",
        "The ball: they do not count.",
        lambda: obj((np.concatenate([make.ball()[0], [(np.nan,) * 3, (np.inf,) * 3, (1e300,) * 3]]), make.ball()[1])),
        ".obj",
    ),
    Case(
        "inside-out",
        "Every triangle is wound the wrong way.",
        "The torus, and a sentence that it was turned.",
        lambda: stl(make.reversed_winding(make.ring())),
        ".stl",
    ),
    Case(
        "mixed-winding",
        "Every third triangle is wound the wrong way.",
        "The torus, and a sentence that they were reversed.",
        lambda: ply(make.reversed_winding(make.ring(), 3)),
        ".ply",
    ),
    Case(
        "soup",
        "No two triangles share a vertex.",
        "The torus, closed: equal places are one vertex.",
        lambda: stl(make.ring()),
        ".stl",
    ),
    Case(
        "pages",
        "Three sheets meet in one edge.",
        "Drawn as an open surface.",
        lambda: obj(make.fins()),
        ".obj",
        closed=False,
    ),
    Case(
        "cubes-on-an-edge",
        "Four triangles meet in the edge that two cubes share.",
        "Two cubes, closed.",
        lambda: glb(make.cubes_on_an_edge()),
        ".glb",
    ),
    Case(
        "cones-at-a-point",
        "At the tip that two cones share the weighted normals cancel.",
        "Two cones, each with a normal of its own at the tip.",
        lambda: obj(make.cones_at_a_point()),
        ".obj",
    ),
    Case(
        "zero-normals",
        "The file stores a normal of length zero at every vertex.",
        "The ball: stored normals are not read.",
        lambda: ply(make.ball(), np.zeros_like(make.ball()[0])),
        ".ply",
    ),
    Case(
        "both-sides-of-a-sheet",
        "A closed surface without volume: on every edge two normals cancel.",
        "Thickness 0: the sheet glows.",
        lambda: obj((make.sheet()[0], np.concatenate([make.SQUARE, make.SQUARE[:, ::-1]]))),
        ".obj",
    ),
    Case(
        "self-intersection",
        "Two balls run through each other: the next surface behind the front may be another front.",
        "Thickness to that next surface.",
        lambda: ply(make.joined(make.ball(1280, 0.7, (-0.3, 0, 0)), make.ball(1280, 0.7, (0.3, 0.1, 0.2)))),
        ".ply",
        ASKEW,
    ),
    Case(
        "coincident-shells",
        "One cube twice in the same place, cut along other diagonals: every depth is there twice.",
        "Thickness of one cube, without specks.",
        lambda: obj(make.joined(make.cube(), (make.CORNERS, make.OTHER_DIAGONALS))),
        ".obj",
        ASKEW,
    ),
    Case(
        "nested-shells",
        "A hollow ball with a ball in the hollow.",
        "Thickness of the outer wall alone.",
        lambda: ply(
            make.joined(make.ball(), make.reversed_winding(make.ball(1280, 0.8)), make.ball(1280, 0.4, (0.2, 0, 0)))
        ),
        ".ply",
    ),
]

NAN_VERTEX = make.ball()[0].copy()
NAN_VERTEX[7] = np.nan
INFINITE_VERTEX = make.ball()[0].copy()
INFINITE_VERTEX[7, 1] = np.inf
ONE_POINT = np.zeros((1, 3)), np.zeros((1, 3), np.int64)

UNREADABLE = [
    Case(
        "nan-vertex",
        "One corner is NaN: dropping its triangles would tear a hole.",
        "1 vertex is not finite (NaN or infinity); repair the mesh or export it again",
        lambda: ply((NAN_VERTEX, make.ball()[1])),
        ".ply",
        refused=True,
    ),
    Case(
        "infinite-vertex",
        "One corner is infinite.",
        "1 vertex is not finite (NaN or infinity); repair the mesh or export it again",
        lambda: obj((INFINITE_VERTEX, make.ball()[1])),
        ".obj",
        refused=True,
    ),
    Case(
        "one-vertex",
        "A mesh of one vertex, three times a corner.",
        "no triangle with an extent is left; repair the mesh or export it again",
        lambda: ply(ONE_POINT),
        ".ply",
        refused=True,
    ),
    Case(
        "points-only",
        "Vertices and no triangle.",
        "holds no triangles; export the object as a triangle mesh",
        lambda: obj((make.ball()[0], np.zeros((0, 3), np.int64))),
        ".obj",
        refused=True,
    ),
    Case(
        "missing-vertex",
        "A triangle names a vertex that is not there.",
        "has 1 face that names vertices that are not there; export it again",
        lambda: ply((make.sheet()[0], np.array([(0, 1, 2), (0, 2, 9)]))),
        ".ply",
        refused=True,
    ),
    Case(
        "beyond-float64",
        "The largest distance in the file is no float64.",
        "has coordinates beyond 1e+307; export it in a larger unit",
        lambda: obj((make.ball()[0] * 1.5e308, make.ball()[1])),
        ".obj",
        refused=True,
    ),
    Case(
        "empty-file",
        "No byte at all.",
        "holds no triangles; export the object as a triangle mesh",
        lambda: b"",
        ".obj",
        refused=True,
    ),
    Case(
        "cut-off-file",
        "The second half of the file was lost.",
        "is not a valid PLY file",
        lambda: ply(make.ball())[:20_000],
        ".ply",
        refused=True,
    ),
]
