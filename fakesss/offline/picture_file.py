"""A path-traced picture in a file, as `fakesss render --path-traced` writes it."""

import json
from pathlib import Path
from typing import Any

from fakesss.image_io import check_picture, write_image
from fakesss.offline.path_tracing import path_traced
from fakesss.offline.settings import PathTracing
from fakesss.renderer import picture_warnings
from fakesss.scene import Scene


def traced_file(scene: Scene, settings: PathTracing, out: str | Path) -> dict[str, Any]:
    """Write the path-traced picture of `scene` to a .png or .exr file, and tell what it took and how sure it is.

    `noise` is None where nothing is known of it.
    """
    path = check_picture(out)
    traced = path_traced(scene, settings)
    write_image(path, traced.image, alpha=scene.alpha, comment=comment(traced.provenance))
    height, width = traced.image.shape[:2]
    return {
        "image": str(path),
        "width": width,
        "height": height,
        "samples": traced.samples,
        "noise": traced.provenance["noise"],
        "seconds": traced.seconds,
        "cached": traced.cached,
        "denoised": traced.provenance["denoised"],
        "warnings": [*picture_warnings(traced.image, scene.alpha), *traced.warnings],
        "provenance": traced.provenance,
    }


def comment(provenance: dict[str, Any]) -> str:
    """What stands in the file itself: how it was made, and whether a network smoothed it. Without times."""
    made = {name: value for name, value in provenance.items() if name not in ("seconds", "scene_sha256")}
    denoised = f"Denoised by {made['denoised']}. " if made["denoised"] else ""
    return f"Path-traced, not the shader's. {denoised}{json.dumps(made)}"
