"""A sea shell: a spiral that opens into a wide mouth, its wall thin at the lip and solid at the core.

The centre line of the tube is a logarithmic spiral (Thompson, *On Growth and Form*, 1917, chapter XI). Made for this
package. Units are arbitrary; the mesh is scaled afterwards.
"""

import numpy as np

from fakesss.distance import Floats, smooth_max, smooth_min

BOX = ((-1.25, -1.25, -0.75), (1.25, 1.25, 0.75))

GROWTH = 0.17  # of the logarithm of the radius, per radian
TUBE = 0.51  # radius of the tube over the distance of its centre line from the axis
MOUTH = np.radians(25)  # direction in which the shell opens, from +x towards +y
REACH = 0.78  # of the centre line at the mouth
RIBS = 18  # a turn
SOLID = 1.35 * np.pi  # how far behind the mouth the hollow ends, radians


def wall_field(points: Floats, turn: int) -> Floats:
    """Distance to the wall of one turn of the spiral: 0 is the last, -1 the continuation that the mouth cuts off."""
    x, y, z = points.T
    radius = np.hypot(x, y)
    angle = np.arctan2(y, x) - MOUTH
    angle = np.where(angle > 0, angle - 2 * np.pi, angle) - 2 * np.pi * turn  # 0 at the mouth, falling inwards
    centre = REACH * np.exp(GROWTH * angle)
    inwards = np.clip(-angle / SOLID, 0, 1)  # 0 at the mouth, 1 where the tube has become solid
    ribs = np.cos(RIBS * angle) * (1 - 0.6 * inwards)
    tube = TUBE * centre * (1 + 0.035 * ribs)
    offset = (np.hypot(radius - centre, z / 1.1) - tube) / np.sqrt(1 + GROWTH**2)
    wall = 0.030 + 0.008 * ribs + 0.06 * inwards + 1.1 * tube * inwards**2.5
    return smooth_max(smooth_max(offset, -(offset + wall), 0.02), radius * angle, 0.03)


def field(points: Floats) -> Floats:
    """The distance inside `BOX`."""
    total: Floats = np.sqrt((points**2).sum(axis=1)) - 0.05  # the core, where the turns become too small
    for turn in (-1, 0, 1, 2):
        total = smooth_min(total, wall_field(points, turn), 0.04)
    return total
