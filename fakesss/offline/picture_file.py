"""A path-traced picture in a file, as `fakesss render --path-traced` writes it."""

from pathlib import Path
from typing import Any

from fakesss.image_io import check_picture, write_image
from fakesss.offline.path_tracing import path_traced
from fakesss.offline.settings import PathTracing
from fakesss.renderer import picture_warnings
from fakesss.scene import Scene


def traced_file(scene: Scene, settings: PathTracing, out: str | Path) -> dict[str, Any]:
    """Write the path-traced picture of `scene` to a .png or .exr file, and tell what it took and how sure it is."""
    path = check_picture(out)
    traced = path_traced(scene, settings)
    write_image(path, traced.image, alpha=scene.alpha)
    height, width = traced.image.shape[:2]
    return {
        "image": str(path),
        "width": width,
        "height": height,
        "samples": traced.samples,
        "noise": traced.noise,
        "seconds": traced.seconds,
        "cached": traced.cached,
        "warnings": list(picture_warnings(traced.image, scene.alpha)),
        "provenance": traced.provenance,
    }
