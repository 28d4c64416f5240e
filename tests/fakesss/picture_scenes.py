"""Scenes that several tests of pictures start from."""

from pathlib import Path
from typing import Any

import trimesh

from fakesss.scene import Scene

DARK = {
    "light.ambient": (0, 0, 0),
    "light.diffuse": (0, 0, 0),
    "light.specular": (0, 0, 0),
    "material.backlight": 0.0,
    "supersampling": 1,
    "background": (0, 0, 0),
    "exposure": 1.0,
    "size": (96, 96),
    "object": "sphere:20000",
}


def dark(**changes: Any) -> Scene:
    """A sphere without any light, and then `changes` with __ for the dot."""
    return Scene().replace({**DARK, **{path.replace("__", "."): value for path, value in changes.items()}})


def sheet_file(folder: Path) -> str:
    """An open square facing +z, wound counter-clockwise."""
    path = folder / "sheet.ply"
    corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
    trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 3]], process=False).export(path)
    return str(path)
