"""The default object: a seated figure holding a child, smooth, with holes, thin limbs and a thin mantle.

Made for this package, in the spirit of small abstract sculpture. Units are arbitrary; the mesh is scaled afterwards.
"""

import numpy as np

from fakesss.distance import Custom, Ellipsoid, Floats, Joined, Tube, smooth_max, turned

BOX = ((-1.0, -1.0, -0.75), (1.0, 1.25, 0.75))

# x, y, z, radius: y is up, +z is the front
# fmt: off
TORSO = [(0.02, 0.56, -0.05, 0.10), (0.0, 0.42, -0.07, 0.17), (0.0, 0.16, -0.05, 0.12), (0.0, -0.12, -0.02, 0.19),
         (0.0, -0.42, 0.0, 0.24), (0.0, -0.66, 0.0, 0.12)]
NECK = [(0.03, 0.80, 0.02, 0.050), (0.01, 0.66, -0.02, 0.050), (0.01, 0.50, -0.05, 0.10)]
NOSE = [(0.045, 0.93, 0.15, 0.025), (0.055, 0.86, 0.18, 0.030), (0.065, 0.80, 0.165, 0.035)]
ARM = [(0.10, 0.50, -0.05, 0.10), (0.26, 0.53, -0.05, 0.085), (0.44, 0.34, 0.0, 0.055), (0.50, 0.10, 0.12, 0.048),
       (0.36, -0.07, 0.29, 0.040), (0.16, -0.10, 0.37, 0.032), (0.0, -0.07, 0.38, 0.040)]
THIGH = [(0.10, -0.52, 0.0, 0.21), (0.34, -0.45, 0.11, 0.17), (0.50, -0.43, 0.18, 0.13)]
LEG = [(0.10, -0.52, 0.0, 0.20), (0.36, -0.44, 0.12, 0.165), (0.60, -0.42, 0.22, 0.125), (0.78, -0.58, 0.28, 0.088),
       (0.62, -0.77, 0.37, 0.062), (0.34, -0.80, 0.44, 0.050), (0.05, -0.75, 0.45, 0.055), (-0.08, -0.73, 0.43, 0.055)]
CHILD = [(0.13, 0.31, 0.29, 0.045), (0.12, 0.22, 0.31, 0.075), (0.08, 0.05, 0.33, 0.085), (0.05, -0.08, 0.345, 0.085)]
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
    radii = np.array([0.62, 0.94, 0.54])
    centre = points - np.array([0.0, 0.20, 0.14])
    # soft folds that run out from the hips and fade towards them
    folds = np.cos(10 * np.arctan2(x, y + 0.55)) * np.clip((np.hypot(x, y + 0.55) - 0.15) / 0.5, 0, 1) ** 2
    scaled = centre / radii
    size = np.sqrt((scaled**2).sum(axis=1))
    slope = np.sqrt(((scaled / radii) ** 2).sum(axis=1))
    sheet = np.abs(size - 1) * size / np.maximum(slope, 1e-9)
    border = smooth_max(z + 0.11 - 0.20 * (y - 0.2) + 0.015 * folds, -0.70 - y, 0.25)
    inside = np.clip(-border / 0.5, 0, 1)
    half = 0.022 + 0.07 * inside**1.5 * (1 + 0.6 * folds)
    return smooth_max(sheet - half, border, 0.06)


# the distance inside `BOX`
field = Joined(
    [
        (Custom(mantle, (-0.75, -0.75, -0.5), (0.75, 1.25, 0.35)), 0.05),
        (Tube(TORSO), 0.06),
        (Ellipsoid((0.0, -0.57, 0.0), (0.42, 0.24, 0.32)), 0.15),
        (Tube(NECK), 0.08),
        (Ellipsoid((0.045, 0.86, 0.06), (0.105, 0.145, 0.125), turned(x=18, z=-14)), 0.05),
        (Tube(NOSE), 0.06),
        (Tube(THIGH), 0.09),
        (mirrored(THIGH), 0.09),
        (Tube(LEG), 0.02),
        (mirrored(LEG), 0.02),
        (Tube(ARM), 0.06),
        (mirrored(ARM), 0.06),
        (Tube(CHILD), 0.05),
        (Ellipsoid((0.13, 0.41, 0.28), (0.078, 0.095, 0.085), turned(z=-15)), 0.035),
        (Tube(CHILD_ARM), 0.06),
        (Tube(CHILD_LEG), 0.05),
    ]
)
