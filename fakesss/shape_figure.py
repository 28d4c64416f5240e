"""The default object: a seated figure holding a child, smooth, with holes, thin limbs and a thin mantle.

Made for this package, in the spirit of small abstract sculpture. Units are arbitrary; the mesh is scaled afterwards.
"""

from functools import cache

import numpy as np

from fakesss.distance import Custom, Ellipsoid, Floats, Joined, Tube, smooth_max, turned
from fakesss.isosurface import surface
from fakesss.solids import Surface

BOX = ((-1.0, -1.0, -0.75), (1.0, 1.15, 0.75))

# x, y, z, radius: y is up, +z is the front
# fmt: off
TORSO = [(0.02, 0.56, -0.05, 0.10), (0.0, 0.42, -0.07, 0.17), (0.0, 0.16, -0.05, 0.12), (0.0, -0.12, -0.02, 0.19),
         (0.0, -0.45, 0.0, 0.27)]
NECK = [(0.03, 0.80, 0.02, 0.050), (0.01, 0.66, -0.02, 0.050), (0.01, 0.50, -0.05, 0.10)]
NOSE = [(0.045, 0.90, 0.17, 0.012), (0.06, 0.84, 0.21, 0.020), (0.065, 0.79, 0.185, 0.020)]
ARM = [(0.10, 0.50, -0.05, 0.10), (0.26, 0.53, -0.05, 0.085), (0.44, 0.34, 0.0, 0.055), (0.50, 0.10, 0.12, 0.048),
       (0.36, -0.07, 0.29, 0.040), (0.16, -0.10, 0.37, 0.032), (0.0, -0.07, 0.38, 0.040)]
THIGH = [(0.10, -0.52, 0.0, 0.21), (0.36, -0.44, 0.12, 0.17), (0.60, -0.42, 0.22, 0.125), (0.73, -0.53, 0.26, 0.09)]
SHIN = [(0.66, -0.45, 0.24, 0.09), (0.77, -0.58, 0.27, 0.09), (0.60, -0.77, 0.36, 0.062), (0.34, -0.80, 0.43, 0.050),
        (0.05, -0.74, 0.45, 0.055), (-0.10, -0.71, 0.43, 0.06)]
CHILD = [(0.12, 0.31, 0.27, 0.045), (0.11, 0.22, 0.28, 0.080), (0.06, 0.05, 0.28, 0.090), (0.02, -0.12, 0.27, 0.11)]
CHILD_ARM = [(0.04, 0.23, 0.30, 0.036), (-0.10, 0.25, 0.34, 0.028), (-0.19, 0.40, 0.25, 0.022),
             (-0.12, 0.56, 0.08, 0.024), (-0.02, 0.62, 0.0, 0.03)]
CHILD_LEG = [(0.05, -0.10, 0.30, 0.075), (-0.08, -0.16, 0.38, 0.055), (-0.20, -0.28, 0.40, 0.038),
             (-0.24, -0.44, 0.36, 0.03), (-0.26, -0.50, 0.40, 0.03)]
# fmt: on


def mirrored(points: list[tuple[float, float, float, float]]) -> Tube:
    """A limb with left and right exchanged."""
    return Tube([(-x, y, z, radius) for x, y, z, radius in points])


def mantle(points: Floats) -> Floats:
    """A thin cloak behind head and shoulders, in soft folds, thinnest at its free border."""
    x, y, z = points.T
    radii = np.array([0.60, 0.86, 0.52])
    centre = points - np.array([0.0, 0.20, 0.14])
    turn = np.arctan2(x, y + 0.55)  # folds run out from the hips
    scaled = centre / radii
    size = np.sqrt((scaled**2).sum(axis=1))
    slope = np.sqrt(((scaled / radii) ** 2).sum(axis=1))
    sheet = np.abs(size - 1) * size / np.maximum(slope, 1e-9)
    border = smooth_max(z + 0.11 - 0.20 * (y - 0.2) + 0.015 * np.cos(10 * turn), -0.70 - y, 0.25)
    inside = np.clip(-border / 0.5, 0, 1)
    half = 0.017 + 0.075 * inside**1.5 * (1 + 0.6 * np.cos(10 * turn))
    return smooth_max(sheet - half, border, 0.03)


@cache
def field() -> Joined:
    """The distance field inside `BOX`."""
    return Joined(
        [
            (Custom(mantle, (-0.72, -0.75, -0.5), (0.72, 1.15, 0.3)), 0.05),
            (Tube(TORSO), 0.06),
            (Ellipsoid((0.0, -0.57, 0.0), (0.42, 0.24, 0.32)), 0.15),
            (Tube(NECK), 0.08),
            (Ellipsoid((0.045, 0.86, 0.06), (0.105, 0.145, 0.125), turned(x=18, z=-14)), 0.05),
            (Tube(NOSE), 0.05),
            (Tube(THIGH), 0.09),
            (mirrored(THIGH), 0.09),
            (Tube(SHIN), 0.05),
            (mirrored(SHIN), 0.05),
            (Tube(ARM), 0.06),
            (mirrored(ARM), 0.06),
            (Tube(CHILD), 0.05),
            (Ellipsoid((0.13, 0.41, 0.28), (0.078, 0.095, 0.085), turned(z=-15)), 0.035),
            (Tube(CHILD_ARM), 0.035),
            (Tube(CHILD_LEG), 0.05),
        ]
    )


def figure(faces: int) -> Surface:
    """About `faces` triangles of the figure."""
    return surface(field(), BOX, faces)
