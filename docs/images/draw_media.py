"""Draws docs/images/media.png: marble, skin1 and wholemilk of 30 mm, lit from the front and from behind.

Run from the checkout: .venv/bin/python docs/images/draw_media.py (a few minutes; needs the extras offline and denoise).
"""

from pathlib import Path

import numpy as np

from fakesss.image_io import write_image
from fakesss.offline.path_tracing import PathTracing, path_traced
from fakesss.scene import Scene

MEDIA = ("marble", "skin1", "wholemilk")
LIGHTS = ({}, {"azimuth": 180.0, "elevation": 30.0})
SIDE = 160  # pixels


def main() -> None:
    """Writes media.png beside this file: a row of each light, a column of each medium."""
    rows = []
    for light in LIGHTS:
        scene = Scene.from_dict({"object": "figure", "size": (SIDE, SIDE), "light": light}, "draw_media.py")
        settings = [PathTracing(medium=medium, samples=64, denoise=True) for medium in MEDIA]
        rows.append(np.concatenate([path_traced(scene, one).image[..., :3] for one in settings], axis=1))
    write_image(Path(__file__).with_name("media.png"), np.concatenate(rows))


if __name__ == "__main__":
    main()
