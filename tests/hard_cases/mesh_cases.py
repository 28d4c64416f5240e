"""Hard cases that are sound mesh files."""

import hard_meshes as make
import numpy as np
from hard_case import Case
from hard_meshes import obj, ply, stl

FAR = (1e7, -1e7, 1e7)
ASKEW = {"camera.azimuth": 25.0, "camera.elevation": 20.0}

SIZES = [
    Case(
        "tiny-object",
        "A torus 2e-6 units across: an absolute epsilon swallows it.",
        "The picture of the same torus at any other size.",
        lambda: obj((make.ring()[0] * 1e-6, make.ring()[1])),
        ".obj",
    ),
    Case(
        "huge-object",
        "A torus 2e6 units across: an absolute epsilon is nothing to it.",
        "The picture of the same torus at any other size.",
        lambda: ply((make.ring()[0] * 1e6, make.ring()[1])),
        ".ply",
    ),
    Case(
        "far-away-object",
        "1e7 times its size away from the origin: float32 would leave one step for the whole object.",
        "The picture of the same torus at the origin.",
        lambda: obj((make.ring()[0] + 2 * np.array(FAR), make.ring()[1])),
        ".obj",
    ),
    Case(
        "far-away-tiny-object",
        "Both at once.",
        "The picture of the same torus at the origin.",
        lambda: ply(((make.ring()[0] + 2 * np.array(FAR)) * 1e-6, make.ring()[1])),
        ".ply",
    ),
    Case(
        "two-specks",
        "Two balls 250 of their sizes apart: each is about a pixel wide.",
        "Two specks.",
        lambda: stl(make.joined(make.ball(80, 4e-3, (-1, 0, 0)), make.ball(80, 4e-3, (1, 0, 0)))),
        ".stl",
        {"size": (256, 256)},
    ),
    Case(
        "needle",
        "A thousand times as long as wide: no pixel is far from the outline.",
        "A line, thin all along.",
        lambda: obj(make.needle(2e-3)),
        ".obj",
    ),
    Case(
        "invisible-needle",
        "A million times as long as wide.",
        "The background alone, and a warning: no sample meets it.",
        lambda: obj(make.needle(2e-6)),
        ".obj",
        empty=True,
    ),
    Case(
        "thin-plate",
        "A closed plate 1e-7 of its width thick: thinner than the peel can part.",
        "Thickness 0: the plate glows.",
        lambda: ply(make.cube((1, 1, 1e-7))),
        ".ply",
        ASKEW,
    ),
    Case(
        "tilted-thin-plate",
        "The same plate, leaning: in float32 its two sides are one.",
        "Thickness 0: the plate glows.",
        lambda: ply((make.turned(make.cube((1, 1, 1e-7))[0], 20, 30), make.CUBE)),
        ".ply",
    ),
    Case(
        "many-triangles",
        "245,000 triangles on a small picture: several to a pixel.",
        "A smooth ball. A test with larger counts loads and draws 5,000,000.",
        lambda: stl(make.ball(245_000)),
        ".stl",
    ),
    Case(
        "four-triangles",
        "A tetrahedron: as few as a closed surface can have, every edge a crease.",
        "Flat sides with hard edges.",
        lambda: obj((make.CORNERS[[0, 3, 5, 6]], np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]))),
        ".obj",
    ),
]

OPEN = [
    Case(
        "open-sheet",
        "Nothing lies behind the front layer.",
        "Thickness by `open_surface`: thin, it glows.",
        lambda: stl(make.sheet()),
        ".stl",
        closed=False,
    ),
    Case(
        "opaque-sheet",
        "The same with `open_surface` thick.",
        "No backlight at all.",
        lambda: stl(make.sheet()),
        ".stl",
        {"open_surface": "thick"},
        closed=False,
    ),
    Case(
        "sheet-from-behind",
        "The side that is seen faces away.",
        "Lit as if it faced the viewer.",
        lambda: obj(make.sheet()),
        ".obj",
        {"camera.azimuth": 180.0},
        closed=False,
    ),
    Case(
        "sheet-edge-on",
        "Everything lies in one plane with the line of sight and covers no sample.",
        "The background alone, and a warning.",
        lambda: ply(make.sheet()),
        ".ply",
        {"camera.azimuth": 90.0, "camera.elevation": 0.0},
        closed=False,
        empty=True,
    ),
    Case(
        "cube-edge-on",
        "Four sides of a cube lie in one plane with the line of sight.",
        "Thickness of the cube, no specks from the sides.",
        lambda: obj(make.cube()),
        ".obj",
        {"camera.azimuth": 0.0, "camera.elevation": 0.0, "camera.field_of_view": 1.0},
    ),
    Case(
        "single-triangle",
        "The smallest surface there is.",
        "A glowing triangle.",
        lambda: obj((make.sheet()[0][:3], np.array([(0, 1, 2)]))),
        ".obj",
        closed=False,
    ),
    Case(
        "half-ball",
        "Part of the picture has a second layer and part has not.",
        "Both, each by its rule.",
        lambda: ply((make.ball()[0], make.ball()[1][make.ball()[0][make.ball()[1]].mean(axis=1)[:, 0] > 0])),
        ".ply",
        {"camera.azimuth": -60.0},
        closed=False,
    ),
    Case(
        "one-sided-band",
        "A Möbius strip cannot be wound consistently.",
        "Drawn as an open surface.",
        lambda: obj(make.moebius()),
        ".obj",
        closed=False,
    ),
]
