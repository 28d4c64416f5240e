"""The base scene with some fields set otherwise: what a control is, and what a path-traced picture may be."""

from collections.abc import Mapping
from typing import Any

from fakesss.problem import BadInput
from fakesss.scene import Scene, check_path
from stimuli.levels import MUST_BE, is_level, leaves, written

ONE_SIZE = "all pictures of a study have one size; set it in [scene]"  # on screen, and for the cues that count pixels


def changed(base: Scene, table: Mapping[str, Any], where: str) -> Scene:
    """`base` with the fields of `table` set, or `BadInput` naming the place, the field and the mend.

    TOML takes material.backlight = 0 for a table in a table, "material.backlight" = 0 not: both are meant.
    """
    changes = list(leaves(table))
    paths = [path for path, _ in changes]
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise BadInput(f"{where}: {twice} stands twice; remove one")
    for path, value in changes:
        check_path(path, where, len(base.lights))
        if path == "size":
            raise BadInput(f"{where}: size = {written(value)}: {ONE_SIZE}")
        if not is_level(value):
            raise BadInput(f"{where}: {path} = {written(value)}: {MUST_BE}")
    scene = base.replace(changes, where)
    check_opaque(scene, where)
    return scene


def check_opaque(scene: Scene, where: str) -> None:
    """`BadInput` naming the place if the picture would have no background of its own."""
    if scene.alpha:
        raise BadInput(f"{where}: a browser would show its page through the picture; set alpha = false")
