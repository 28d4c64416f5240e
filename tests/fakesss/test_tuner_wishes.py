"""Whatever is wished, the answer is a frame or one sentence, and the next wish is answered too."""

import json
from collections.abc import Iterator
from typing import Any, Literal, get_args, get_origin

import pytest
from hypothesis import event, given
from hypothesis import strategies as st
from pydantic.fields import FieldInfo
from tuner_server import Frame, Tab, tab, tuned

from fakesss.calls import EFFECTS
from fakesss.lights import Light
from fakesss.scene import Scene, light_paths, scene_paths
from fakesss.tuner.looks import LOOKS
from fakesss.tuner.wishes import OFF, Settings

pytestmark = pytest.mark.gl
BASE = Scene(object="sphere:1000", size=(24, 16), occlusion={"rays": 4}, layers={"rays": 4})  # type: ignore[arg-type]
SLOW = {"size", "occlusion.rays", "layers.rays", "shadow.map_size", "object", "supersampling", "occlusion.samples"}
PATHS = [path for path in (*scene_paths(), *light_paths(2)) if path not in SLOW]

numbers = st.one_of(
    st.floats(), st.integers(-(10**20), 10**20), st.sampled_from([0, -1, 0.0, -0.0, 1e-30, 1e30, 0.5, 1, 2, 90, 360.0])
)
CHOICES = "point spot directional peel auto total-path bridged local pcf disc hard screen-space baked survey 9x9 thick"
words = st.one_of(st.text(max_size=8), st.sampled_from(CHOICES.split()))
values = st.recursive(
    st.one_of(st.none(), st.booleans(), numbers, words), lambda inner: st.lists(inner, max_size=4), max_leaves=4
)


def plausible(path: str) -> st.SearchStrategy[Any]:
    """Values that the field may well have."""
    unit = st.floats(0, 1)
    field = Light.model_fields[path.split(".")[-1]] if path.startswith("lights.") else field_at(path)
    if get_origin(field.annotation) is Literal:
        return st.sampled_from(get_args(field.annotation))
    if isinstance(field.default, bool):
        return st.booleans()
    if isinstance(field.default, tuple):
        return st.lists(unit, min_size=3, max_size=3)
    return st.one_of(unit, st.floats(1, 90), st.integers(1, 64))


def field_at(path: str) -> FieldInfo:
    """The pydantic field of a scene's path."""
    *parents, leaf = path.split(".")
    model: Any = Scene
    for parent in parents:
        model = model.model_fields[parent].annotation
    field: FieldInfo = model.model_fields[leaf]
    return field


def changes_of(paths: list[str], prefix: str = "") -> st.SearchStrategy[dict[str, Any]]:
    """Some of these paths with values that they may have."""
    known = st.lists(st.sampled_from(paths), max_size=4, unique=True)
    return known.flatmap(lambda some: st.fixed_dictionaries({path: plausible(prefix + path) for path in some}))


lights = st.lists(changes_of(sorted(Light.model_fields), "lights.0."), max_size=3)
changes = st.one_of(
    changes_of([path for path in PATHS if not path.startswith("lights")]),
    changes_of([path for path in PATHS if not path.startswith("lights")]),
    st.dictionaries(st.sampled_from(PATHS), values, max_size=4),
    st.fixed_dictionaries({"lights": lights}, optional={"material.backlight": numbers}),
    st.fixed_dictionaries({"object": st.one_of(st.just("torus:1000"), st.text(max_size=12))}),
    st.fixed_dictionaries({"size": st.lists(st.integers(-1, 40), max_size=3), "supersampling": st.integers(0, 3)}),
    st.dictionaries(st.text(max_size=12), values, max_size=2),
)
effects = st.dictionaries(st.sampled_from([*EFFECTS, "bloom"]), st.sampled_from(["on", "off", "auto"]), max_size=3)
wishes = st.fixed_dictionaries(
    {"settings": st.fixed_dictionaries({"changes": changes}, optional={"effects": effects})},
    optional={"view": st.sampled_from([*LOOKS, "nothing"]), "moving": st.booleans()},
)


@pytest.fixture(scope="module")
def viewer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tab]:
    with tuned(BASE, tmp_path_factory.mktemp("tuner")) as url, tab(url) as one:
        one.finished()
        yield one


def answer(viewer: Tab, wish: Any) -> Frame | dict[str, Any]:
    """What comes for a wish that is sent as it is."""
    viewer.number += 1
    viewer.messages.clear()
    message = {**wish, "number": viewer.number} if isinstance(wish, dict) else wish
    viewer.socket.send(json.dumps(message))
    while True:
        came = viewer.next()
        if isinstance(came, Frame) and came.header["number"] == viewer.number:
            return came
        if isinstance(came, dict) and came["type"] == "message" and came.get("number", viewer.number) == viewer.number:
            return came


@given(wish=wishes)
def test_every_wish_is_answered(viewer: Tab, wish: dict[str, Any]) -> None:
    came = answer(viewer, wish)
    event(type(came).__name__)
    if isinstance(came, Frame):
        assert came.image[:4] in (b"\x89PNG", b"\xff\xd8\xff\xe0")
        return
    assert came["level"] in ("error", "info") and "fault of the program" not in came["text"], came


@given(message=st.one_of(values, st.dictionaries(st.text(max_size=9), values, max_size=3)))
def test_every_message_is_answered(viewer: Tab, message: Any) -> None:
    came = answer(viewer, message)
    assert isinstance(came, Frame) or "fault of the program" not in came["text"], came


@given(names=st.dictionaries(st.sampled_from(sorted(EFFECTS)), st.sampled_from(["on", "off"]), max_size=6))
def test_switches_are_part_of_the_scene(names: dict[str, Any]) -> None:
    """An effect switched off leaves its mark in the saved scene; one switched on may be forced too."""
    settings = Settings(changes={"lights": [{}, {}]}, effects=names)
    scene = settings.scene(BASE)
    assert settings.forced == {name for name, switch in names.items() if switch == "on"}
    for name, switch in names.items():
        if switch == "off":
            assert all(scene.at(path) == value for path, value in OFF[name].items())
            assert EFFECTS[name].why_not(scene)
    if "shadows" in names:
        assert {light.shadows for light in (scene.light, *scene.lights)} == {names["shadows"] == "on"}
