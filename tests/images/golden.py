"""The pictures that must not change unnoticed. `python tests/images/golden.py` draws the references again.

On the renderer that drew the references the pixels must be equal, byte for byte; on another one a picture may differ by
at most 2/255 anywhere and 0.1/255 on average.
"""

import json
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from tqdm import tqdm

from fakesss.image_io import encode_png, encode_png8
from fakesss.renderer import shared_renderer
from fakesss.scene import Scene

HERE = Path(__file__).parent
REFERENCES = HERE / "references"
FAILED = HERE / "failed"
DRAWN_BY = REFERENCES / "drawn_by.json"

BASE = Scene(object="knot:8000", size=(192, 192))
GOLDEN: dict[str, Scene] = {
    "default": BASE,
    "as-published": BASE.replace({"style": "as published"}),
    "exact-layer": BASE.replace({"blur.enabled": False, "size": (160, 121), "supersampling": 1}),
    "light-only": BASE.replace({"material.backlight": 0.0, "object": "torus:8000"}),
    "screen-space-occlusion": BASE.replace({"occlusion.method": "screen-space", "light.ambient": (0.6, 0.6, 0.6)}),
    "shadows": BASE.replace({"light.shadows": True, "light.azimuth": -70.0, "material.diffuse_contribution": 0.3}),
    "lights": BASE.replace(
        {
            "shadow.filter": "disc",
            "lights": [
                {"kind": "point", "azimuth": 60.0, "distance": 1.1, "attenuation": (0.2, 0, 1), "shadows": True},
                {"kind": "spot", "elevation": 80.0, "cutoff": 15.0, "ambient": (0, 0, 0), "diffuse": (0, 1, 3)},
            ],
        }
    ),
    "backlight-only": BASE.replace(
        {"material.ambient": 0.0, "material.diffuse_contribution": 0.0, "material.specular_contribution": 0.0}
    ),
}


def pixels(png: Path | IO[bytes]) -> NDArray[np.int16]:
    return np.asarray(Image.open(png)).astype(np.int16)


def drawn(name: str) -> bytes:
    return encode_png(shared_renderer().render(GOLDEN[name]).image)


def write_failure(name: str, png: bytes) -> Path:
    """The picture, its reference and their difference, eight times enlarged in value, side by side in a folder."""
    FAILED.mkdir(exist_ok=True)
    image, reference = FAILED / f"{name}.image.png", FAILED / f"{name}.reference.png"
    image.write_bytes(png)
    reference.write_bytes((REFERENCES / f"{name}.png").read_bytes())
    difference = np.clip(np.abs(pixels(image) - pixels(reference)) * 8, 0, 255).astype(np.uint8)
    (FAILED / f"{name}.difference.png").write_bytes(encode_png8(difference))
    return FAILED


def drawn_by() -> dict[str, Any]:
    facts: dict[str, Any] = json.loads(DRAWN_BY.read_text())
    return facts


def regenerate() -> None:
    REFERENCES.mkdir(exist_ok=True)
    for name in tqdm(GOLDEN, disable=None):
        (REFERENCES / f"{name}.png").write_bytes(drawn(name))
    gpu = shared_renderer().gpu
    DRAWN_BY.write_text(json.dumps({"gl_renderer": gpu.renderer, "gl_version": gpu.version}, indent=1) + "\n")


if __name__ == "__main__":
    regenerate()
