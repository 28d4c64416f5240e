"""What `fakesss fit -o DIR` writes: the fitted scene, the numbers, the pictures, and a page of them."""

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomli_w

from fakesss.image_io import write_image
from fakesss.offline.fit_report import Report
from fakesss.output import check_writable, make_folder, write_atomically
from fakesss.scene import Scene

SCENE, DOCUMENT, TABLE = "fitted.toml", "fit.json", "parameters.csv"
COLUMNS = ("parameter", "start", "fitted", "low", "high", "standard_error")


def check_folder(folder: Path) -> None:
    """`folder` made if it is not there; `BadInput` where nothing can be written. Asked for before the work."""
    make_folder(folder)
    check_writable(folder / SCENE)


def write_report(report: Report, folder: Path) -> None:
    """Every file into `folder`. Raises `BadInput` where it cannot be written."""
    from fakesss.accuracy.page_fit import write_fit_page  # loads matplotlib

    write_atomically(folder / SCENE, toml(report.scene, report.document).encode())
    write_atomically(folder / DOCUMENT, (json.dumps(report.document, indent=1) + "\n").encode())
    write_atomically(folder / TABLE, table(report.document["parameters"]).encode())
    for name, picture in report.pictures.items():
        write_image(folder / f"{name}.png", picture)
        write_image(folder / f"{name}.exr", picture)
    write_fit_page(report.document, folder, report.pictures)


def toml(scene: Scene, document: Mapping[str, Any]) -> str:
    """The scene as `fakesss render` reads it, with where it comes from; a mesh file's path is made absolute."""
    from fakesss.shapes import is_mesh_file

    if is_mesh_file(scene.object):
        scene = scene.replace({"object": str(Path(scene.object).resolve())})
    about = f"# {document['scene']} fitted to {document['medium']}, {document['size_mm']:g} mm across, by `fakesss fit`"
    return f"{about}\n# {document['sentence']}\n\n{tomli_w.dumps(scene.model_dump(mode='json', exclude_none=True))}"


def table(parameters: Mapping[str, Any]) -> str:
    """CSV, a row for each number: the channels of a colour are .0, .1 and .2."""
    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    writer.writerow(COLUMNS)
    for path, entry in parameters.items():
        values = [entry[column] for column in COLUMNS[1:]]
        if isinstance(entry["fitted"], list):
            writer.writerows([f"{path}.{index}", *row] for index, row in enumerate(zip(*values, strict=True)))
        else:
            writer.writerow([path, *values])
    return lines.getvalue()
