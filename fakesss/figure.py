"""The default object: a seated figure holding a child, smooth, with holes, thin limbs and a thin mantle.

Made for this package in the spirit of small abstract sculpture. Units are arbitrary; the mesh is scaled afterwards.
"""

import numpy as np

from fakesss.distance import Custom, Ellipsoid, Floats, Joined, Tube, smooth_max, turned
from fakesss.isosurface import surface
from fakesss.solids import Surface

BOX = ((-0.95, -1.0, -0.75), (0.95, 1.15, 0.75))


def mantle(points: Floats) -> Floats:
    """A thin curved cloak behind the head and shoulders, thinnest at its free border."""
    x, y, z = points.T
    centre = points - np.array([0.0, 0.22, 0.12])
    scaled = centre / np.array([0.62, 0.80, 0.50])
    size = np.sqrt((scaled**2).sum(axis=1))
    slope = np.sqrt(((scaled / np.array([0.62, 0.80, 0.50])) ** 2).sum(axis=1))
    sheet = np.abs(size - 1) * size / np.maximum(slope, 1e-9)
    # free border: an oblique plane in front, rounding off below
    border = z + 0.10 - 0.22 * (y - 0.2) + 0.02 * np.cos(6 * y)
    below = -0.62 - y
    inside = smooth_max(border, below, 0.2)
    thickness = 0.018 + 0.05 * np.clip(-inside / 0.5, 0, 1) ** 1.5
    return smooth_max(sheet - thickness, inside, 0.03)


def mirrored(*points: tuple[float, float, float, float]) -> Tube:
    """A tube with left and right exchanged."""
    return Tube([(-x, y, z, radius) for x, y, z, radius in points])


def field() -> Joined:
    """The figure's distance field inside `BOX`."""
    leg = (
        (0.16, -0.42, 0.02, 0.19),
        (0.40, -0.36, 0.16, 0.15),
        (0.74, -0.26, 0.22, 0.11),
        (0.66, -0.62, 0.26, 0.075),
        (0.42, -0.80, 0.30, 0.06),
        (0.16, -0.76, 0.30, 0.07),
    )
    arm = (
        (0.10, 0.50, -0.04, 0.10),
        (0.27, 0.53, -0.04, 0.085),
        (0.46, 0.28, 0.02, 0.055),
        (0.46, 0.0, 0.20, 0.05),
        (0.24, -0.08, 0.34, 0.036),
        (0.02, -0.04, 0.36, 0.045),
    )
    parts = [
        (Custom(mantle, (-0.72, -0.7, -0.5), (0.72, 1.1, 0.3)), 0.05),
        (
            Tube(
                [
                    (0.0, 0.55, -0.04, 0.11),
                    (0.0, 0.40, -0.06, 0.17),
                    (0.01, 0.15, -0.06, 0.12),
                    (0.0, -0.15, -0.02, 0.20),
                    (0.0, -0.45, 0.0, 0.26),
                ]
            ),
            0.06,
        ),
        (Ellipsoid((0.0, -0.58, 0.02), (0.40, 0.22, 0.30)), 0.15),
        (Tube([(0.03, 0.78, 0.02, 0.055), (0.0, 0.64, -0.02, 0.055), (0.0, 0.5, -0.04, 0.09)]), 0.08),
        (Ellipsoid((0.05, 0.84, 0.07), (0.11, 0.15, 0.125), turned(x=18, z=-14)), 0.05),
        (Tube(leg), 0.09),
        (mirrored(*leg), 0.09),
        (Tube(arm), 0.06),
        (mirrored(*arm), 0.06),
        (
            Tube(
                [
                    (0.10, 0.30, 0.26, 0.05),
                    (0.09, 0.20, 0.28, 0.085),
                    (0.05, 0.02, 0.27, 0.095),
                    (0.0, -0.12, 0.25, 0.12),
                ]
            ),
            0.05,
        ),
        (Ellipsoid((0.11, 0.40, 0.28), (0.085, 0.10, 0.09), turned(z=15)), 0.035),
        (
            Tube(
                [
                    (0.03, 0.22, 0.30, 0.038),
                    (-0.12, 0.27, 0.33, 0.03),
                    (-0.17, 0.44, 0.22, 0.024),
                    (-0.06, 0.60, 0.04, 0.032),
                ]
            ),
            0.035,
        ),
    ]
    return Joined(parts)


def figure(faces: int) -> Surface:
    return surface(field(), BOX, faces)
