"""A scene's numbers, one by one, and the scene with one of them changed a little."""

from collections.abc import Iterator
from typing import Any

from fakesss.camera import View
from fakesss.problem import BadInput
from fakesss.scene import Scene

CHANGE = 1e-4  # of a number's size; of its unit where it is 0
FARTHEST = 1e4  # of any plane, radii

Place = tuple[str | int, ...]


def with_given_camera(scene: Scene) -> Scene:
    """The same view, with the distance and the planes that were left empty written out as far as they may be."""
    view = View.of(scene.camera, scene.size)
    given = {"camera.distance": view.distance, "camera.near": view.near, "camera.far": view.far}
    return scene.replace({path: value for path, value in given.items() if value <= FARTHEST})


def numbers(value: Any, place: Place = ()) -> Iterator[Place]:
    """Where the scene (or part of it, as JSON values) holds a number that can be changed a little."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for key, inner in items:
            yield from numbers(inner, (*place, key))
    elif isinstance(value, float):
        yield place


def changed(scene: Scene, place: Place) -> Scene:
    """With the number at `place` larger by `CHANGE`, or smaller where it may not be larger."""
    data = scene.model_dump(mode="json")
    holder = data
    for key in place[:-1]:
        holder = holder[key]
    before = holder[place[-1]]
    step = CHANGE * (abs(before) or 1)
    try:
        holder[place[-1]] = before + step
        return Scene.from_dict(data, "larger")
    except BadInput:
        holder[place[-1]] = before - step
        return Scene.from_dict(data, "smaller")
