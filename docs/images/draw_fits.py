"""Makes the fits of docs/accuracy.md again: `python docs/images/draw_fits.py` (about 15 minutes, path tracing).

Prints the tables' rows and draws fits.png: of each medium target and fit, lit from the front and from behind.
"""

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from fakesss.accuracy.drawings_maps import frame_of
from fakesss.colour import to_8bit
from fakesss.offline.fit_report import Named, Report, fit_medium
from fakesss.offline.settings import PathTracing
from fakesss.scene import Scene

HERE = Path(__file__).parent
MEDIA = ("marble", "skin1", "ketchup")
LIGHTS: dict[str, dict[str, Any]] = {"front": {"light.shadows": True}, "behind": {"light.azimuth": 180.0}}
SIZE, SAMPLES, STARTS = (256, 256), 128, 3


def fitted(medium: str, light: str) -> Report:
    """The built-in figure in one medium under one light."""
    scene = Scene(size=SIZE).replace(LIGHTS[light])
    return fit_medium(scene, PathTracing(medium=medium, samples=SAMPLES), STARTS, 0, Named("figure", ""))


def rows(medium: str, light: str, told: dict[str, Any]) -> tuple[str, str]:
    """Of the table of parameters, and of errors and times."""
    value = {path.removeprefix("material."): entry["fitted"] for path, entry in told["parameters"].items()}
    order = ("thickness_exponent", "backlight", "diffuse_weight", "diffuse_contribution", "ambient")
    numbers = [f"{value[name]:.2f}" for name in order]
    colour = " ".join(f"{channel:.2f}" for channel in value["diffuse"])
    start, noise, seconds, equal = (told[key] for key in ("start_errors", "noise", "seconds", "matched"))
    errors = [f"{told['rmse']:.3f}", f"{start['rmse']:.3f}", f"{noise['rmse']:.3f}", f"{noise['misfit_rmse']:.3f}"]
    errors += [f"{told['flip']:.2f}", f"{start['flip']:.2f}", f"{noise['flip']:.2f}"]
    times = [f"{seconds['shader']:.2f}", f"{seconds['path_traced']:.0f}"]
    times += [f"{equal['bound']} {equal['samples']:.0f}".strip(), f"{equal['speed_up']:.0f}"]
    first = " | ".join([medium, light, told["thickness"]["fitted"], *numbers, colour])
    return f"| {first} |", f"| {' | '.join([medium, light, *errors, *times])} |"


def pair(report: Report) -> Any:
    """Target and fit side by side."""
    frame = frame_of(report.pictures["target"])
    return np.concatenate([to_8bit(report.pictures[name][frame][..., :3]) for name in ("target", "fitted")], axis=1)


if __name__ == "__main__":
    found = {medium: {light: fitted(medium, light) for light in LIGHTS} for medium in MEDIA}
    for number in range(2):
        for medium, reports in found.items():
            for light, report in reports.items():
                print(rows(medium, light, report.document)[number])
    sheet = np.concatenate([np.concatenate([pair(each) for each in lit.values()], axis=1) for lit in found.values()])
    picture = Image.fromarray(sheet).quantize(256, method=Image.Quantize.MEDIANCUT)
    picture = Image.fromarray(sheet).quantize(256, palette=picture, dither=Image.Dither.FLOYDSTEINBERG)  # no bands
    picture.save(HERE / "fits.png", optimize=True)
