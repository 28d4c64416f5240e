"""A stylised head: thick skull and neck, thin cupped ears, a nose with thin wings.

Made for this package. Units are arbitrary; the mesh is scaled afterwards.
"""

import numpy as np

from fakesss.distance import Custom, Ellipsoid, Floats, Joined, Tube, smooth_max, turned

BOX = ((-1.2, -1.1, -0.9), (1.2, 1.0, 0.9))
BASE = -0.92  # where the neck is cut off flat

# x, y, z, radius: y is up, +z is the front
# fmt: off
NECK = [(0.0, -1.2, -0.14, 0.36), (0.0, -0.80, -0.16, 0.25), (0.0, -0.35, -0.12, 0.24), (0.0, 0.0, -0.1, 0.25)]
NOSE = [(0.0, 0.24, 0.48, 0.040), (0.0, 0.08, 0.55, 0.050), (0.0, -0.13, 0.69, 0.062), (0.0, -0.15, 0.60, 0.06)]
WING = [(0.035, -0.12, 0.56, 0.055), (0.085, -0.13, 0.54, 0.052), (0.09, -0.17, 0.48, 0.05)]
BROW = [(0.04, 0.20, 0.47, 0.06), (0.20, 0.285, 0.44, 0.06), (0.33, 0.21, 0.30, 0.04)]
LIP_ABOVE = [(-0.16, -0.335, 0.43, 0.030), (-0.06, -0.285, 0.53, 0.048), (0.0, -0.32, 0.545, 0.040),
             (0.06, -0.285, 0.53, 0.048), (0.16, -0.335, 0.43, 0.030)]
LIP_BELOW = [(-0.14, -0.350, 0.43, 0.030), (0.0, -0.395, 0.56, 0.058), (0.14, -0.350, 0.43, 0.030)]
# fmt: on


def ear(points: Floats) -> Floats:
    """A leaf-shaped cup on the right, thin between its rim and the head."""
    base, tip = np.array([0.36, -0.02, 0.06]), np.array([0.99, 0.56, -0.10])
    along = (tip - base) / np.sqrt(((tip - base) ** 2).sum())
    across = np.array([-along[1], along[0], 0.25])
    across -= along * (across @ along)
    across /= np.sqrt(across @ across)
    facing = np.cross(along, across)
    local = points - base
    u, v, w = (np.einsum("ij,j->i", local, axis) for axis in (along, across, facing))
    length = np.sqrt(((tip - base) ** 2).sum())
    s = np.clip(u / length, 0, 1)
    width = 0.30 * np.sqrt(np.maximum(4 * (s + 0.12) * (1 - s) / 1.25, 1e-4)) * (1 - 0.35 * s)
    bowl = 0.55 * v * v - 0.10 * np.sin(np.pi * s)
    vein = 0.008 * np.cos(26 * v / (0.4 + s)) * (1 - s)
    half = 0.020 + 0.03 * (1 - s) ** 2 + vein
    outline = np.maximum(np.abs(v) - width, u - length)
    return smooth_max(np.abs(w - bowl) / 1.15 - half, outline, 0.04)


def left(part: Custom | Tube | Ellipsoid) -> Custom:
    """The same form on the other side."""
    low, high = part.box
    return Custom(
        lambda points: part.distance(points * np.array([-1.0, 1.0, 1.0])),
        (-float(high[0]), float(low[1]), float(low[2])),
        (-float(low[0]), float(high[1]), float(high[2])),
    )


def both(part: Custom | Tube | Ellipsoid, blend: float) -> list[tuple[Custom | Tube | Ellipsoid, float]]:
    return [(part, blend), (left(part), blend)]


# the distance inside `BOX`
field = Joined(
    [
        (Ellipsoid((0.0, 0.22, -0.08), (0.47, 0.50, 0.58)), 0.1),
        (Ellipsoid((0.0, -0.12, 0.16), (0.38, 0.46, 0.38)), 0.2),
        (Ellipsoid((0.0, -0.50, 0.36), (0.15, 0.12, 0.14)), 0.22),
        (Ellipsoid((0.0, -0.30, 0.36), (0.20, 0.20, 0.17)), 0.15),
        (Tube(NECK), 0.12),
        (Custom(lambda points: points[:, 1] - BASE, (-2, -2, -2), (2, BASE + 0.1, 2)), -0.06),
        *both(Ellipsoid((0.25, -0.10, 0.38), (0.11, 0.10, 0.09)), 0.15),
        *both(Ellipsoid((0.185, 0.085, 0.575), (0.125, 0.085, 0.10), turned(z=-6)), -0.14),
        (Ellipsoid((0.0, -0.02, 0.46), (0.075, 0.24, 0.15)), 0.08),
        (Tube(NOSE), 0.07),
        (Ellipsoid((0.0, -0.13, 0.50), (0.10, 0.06, 0.12)), 0.06),
        *both(Tube(WING), 0.06),
        *both(Tube(BROW), 0.10),
        *both(Ellipsoid((0.185, 0.085, 0.445), (0.085, 0.06, 0.07)), 0.025),
        (Tube(LIP_ABOVE), 0.04),
        (Tube(LIP_BELOW), 0.04),
        *both(Custom(ear, (0.25, -0.35, -0.5), (1.1, 0.8, 0.45)), 0.07),
    ]
)
