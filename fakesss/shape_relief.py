"""A relief: a rabbit under a sun on a thin tile within a thick frame, as in a porcelain lithophane.

Made for this package. Units are arbitrary; the mesh is scaled afterwards.
"""

import numpy as np

from fakesss.distance import Custom, Ellipsoid, Floats, Joined, Tube, smooth_max, turned

BOX = ((-1.0, -1.0, -0.35), (1.0, 1.0, 0.6))
HALF = 0.82  # of the tile's side
BACK = -0.10  # where the tile's plane back lies

# x, y, z, radius: y is up, +z is the front
# fmt: off
EAR_BACK = [(0.20, 0.30, 0.06, 0.06), (0.13, 0.42, 0.05, 0.075), (0.05, 0.53, 0.02, 0.07), (-0.01, 0.61, -0.02, 0.035)]
EAR_FRONT = [(0.28, 0.30, 0.09, 0.06), (0.31, 0.44, 0.07, 0.08), (0.32, 0.56, 0.04, 0.075), (0.31, 0.65, 0.0, 0.035)]
FORELEG = [(0.22, -0.10, 0.12, 0.12), (0.27, -0.32, 0.12, 0.085), (0.28, -0.50, 0.10, 0.07), (0.38, -0.56, 0.10, 0.06)]
HINDLEG = [(-0.18, -0.30, 0.20, 0.20), (-0.02, -0.42, 0.20, 0.12), (-0.10, -0.55, 0.14, 0.08),
           (0.10, -0.57, 0.14, 0.065)]
# fmt: on


def tile(points: Floats) -> Floats:
    """A thin plate with rays and ground carved in low relief, and a raised rounded frame."""
    x, y, z = points.T
    edge = smooth_max(np.abs(x), np.abs(y), 0.25) - HALF
    frame = 0.20 * np.exp(-(((edge + 0.07) / 0.055) ** 2))
    from_sun = np.hypot(x + 0.42, y - 0.42)
    rays = 0.012 * np.cos(20 * np.arctan2(y - 0.42, x + 0.42)) * np.clip((from_sun - 0.2) / 0.3, 0, 1)
    rays *= np.clip(-(edge + 0.14) / 0.15, 0, 1)  # none on the frame
    sun = 0.09 * np.sqrt(np.maximum(1 - (from_sun / 0.19) ** 2, 0))
    hills = -0.52 + 0.04 * np.sin(3.2 * x + 0.6)
    ground = 0.05 / (1 + np.exp((y - hills) / 0.03))
    front = BACK + 0.042 + rays / (1 + np.exp((hills - y) / 0.03)) + sun + ground + frame
    return smooth_max(smooth_max((z - front) / 1.2, BACK - z, 0.03), edge, 0.05)


# the distance inside `BOX`
field = Joined(
    [
        (Custom(tile, (-0.85, -0.85, BACK), (0.85, 0.85, 0.2)), 0.03),
        (Ellipsoid((-0.12, -0.22, 0.06), (0.36, 0.30, 0.38), turned(z=18)), 0.04),
        (Ellipsoid((-0.20, -0.32, 0.14), (0.24, 0.22, 0.30)), 0.12),
        (Ellipsoid((0.18, -0.06, 0.08), (0.17, 0.20, 0.26), turned(z=-20)), 0.12),
        (Ellipsoid((0.31, 0.20, 0.12), (0.18, 0.14, 0.19), turned(z=-22)), 0.08),
        (Ellipsoid((0.43, 0.14, 0.13), (0.085, 0.075, 0.11)), 0.06),
        (Tube(EAR_BACK), 0.03),
        (Tube(EAR_FRONT), 0.03),
        (Tube(FORELEG), 0.05),
        (Tube(HINDLEG), 0.05),
        (Ellipsoid((-0.50, -0.36, 0.06), (0.085, 0.085, 0.085)), 0.03),
        (Ellipsoid((0.35, 0.235, 0.285), (0.028, 0.028, 0.028)), -0.02),
        # the back stays plane
        (Custom(lambda points: points[:, 2] - BACK, (-2, -2, -2), (2, 2, BACK)), -0.02),
    ]
)
