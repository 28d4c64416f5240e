"""A raised hand, slightly cupped: thick wrist and ball of the thumb, fingers of different thickness, thin webs.

Made for this package. Units are arbitrary; the mesh is scaled afterwards.
"""

import numpy as np

from fakesss.distance import Custom, Ellipsoid, Floats, Joined, Tube, smooth_max, turned

BOX = ((-0.9, -1.35, -0.6), (1.15, 1.3, 0.7))
BASE = -1.25  # where the forearm is cut off flat

# x, y, z, radius: the palm faces +z, fingers point up; x to the right is the side of the thumb
# fmt: off
ARM = [(0.0, -1.5, -0.04, 0.40), (0.0, -1.15, -0.03, 0.34), (0.0, -0.90, 0.0, 0.26), (0.0, -0.6, 0.0, 0.16)]
LITTLE = [(-0.10, -0.80, 0.0, 0.14), (-0.26, -0.48, 0.02, 0.13), (-0.36, -0.14, 0.06, 0.10), (-0.43, 0.12, 0.06, 0.070),
          (-0.50, 0.30, 0.11, 0.066), (-0.56, 0.44, 0.20, 0.054), (-0.59, 0.54, 0.30, 0.042)]
RING = [(-0.05, -0.80, 0.0, 0.14), (-0.12, -0.45, -0.02, 0.13), (-0.18, -0.05, 0.02, 0.11), (-0.22, 0.28, 0.02, 0.080),
        (-0.27, 0.54, 0.08, 0.076), (-0.30, 0.74, 0.19, 0.060), (-0.31, 0.88, 0.32, 0.046)]
MIDDLE = [(0.0, -0.80, 0.0, 0.14), (0.03, -0.42, -0.03, 0.13), (0.04, 0.0, 0.0, 0.115), (0.05, 0.36, 0.0, 0.086),
          (0.05, 0.66, 0.03, 0.082), (0.05, 0.88, 0.11, 0.066), (0.05, 1.06, 0.22, 0.050)]
INDEX = [(0.05, -0.80, 0.0, 0.14), (0.18, -0.42, -0.01, 0.13), (0.27, -0.02, 0.02, 0.115), (0.31, 0.30, 0.0, 0.086),
         (0.35, 0.54, 0.03, 0.080), (0.38, 0.74, 0.09, 0.064), (0.40, 0.90, 0.18, 0.048)]
THUMB = [(0.05, -0.82, 0.04, 0.15), (0.24, -0.62, 0.12, 0.19), (0.46, -0.36, 0.20, 0.13), (0.60, -0.14, 0.25, 0.100),
         (0.72, 0.04, 0.28, 0.092), (0.80, 0.18, 0.30, 0.078), (0.86, 0.28, 0.30, 0.058)]
# fmt: on


def webs(points: Floats) -> Floats:
    """Thin skin between the fingers, highest beside each of them."""
    x, y, z = points.T
    middle = 0.02 + 0.25 * x * x + 0.03 * np.clip(y, 0, 1)
    top = y - 0.24 + 0.5 * (x - 0.02) ** 2
    side = smooth_max(smooth_max(x - 0.29, -0.40 - x, 0.05), -0.3 - y, 0.05)
    half = 0.018 + 0.05 * np.clip(-top / 0.4, 0, 1) ** 1.5
    return smooth_max(np.abs(z - middle) / 1.1 - half, smooth_max(top, side, 0.05), 0.03)


def thumb_web(points: Floats) -> Floats:
    """Thin skin between thumb and index finger, sagging between the two."""
    x, y, z = points.T
    sheet = np.abs(z - 0.06 - 0.36 * (x - 0.25)) / 1.06
    top = y - 0.08 + 2.2 * np.clip((x - 0.20) * (0.72 - x), -0.02, 1)
    below = 0.62 * (x - 0.2) - 0.5 - y  # stays above the thumb's axis
    outline = smooth_max(smooth_max(top, below, 0.05), smooth_max(0.15 - x, x - 0.66, 0.05), 0.05)
    half = 0.018 + 0.06 * np.clip(-top / 0.35, 0, 1) ** 1.5
    return smooth_max(sheet - half, outline, 0.03)


# the distance inside `BOX`
field = Joined(
    [
        (Tube(ARM), 0.1),
        *((Tube(finger), 0.07) for finger in (LITTLE, RING, MIDDLE, INDEX)),
        (Ellipsoid((-0.26, -0.50, 0.10), (0.12, 0.26, 0.12), turned(z=12)), 0.12),
        (Tube(THUMB), 0.12),
        (Custom(webs, (-0.48, -0.4, -0.3), (0.36, 0.35, 0.4)), 0.05),
        (Custom(thumb_web, (0.05, -0.6, -0.2), (0.75, 0.2, 0.45)), 0.05),
        (Custom(lambda points: points[:, 1] - BASE, (-2, -3, -2), (2, BASE + 0.1, 2)), -0.06),
    ]
)
