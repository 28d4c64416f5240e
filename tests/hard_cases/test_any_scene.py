"""Scenes and meshes that nobody chose: values from all over their ranges, triangles between random points."""

from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import numpy as np
import pytest
from annotated_types import Ge, Gt, Le
from catalogue import DRAWN
from hard_meshes import obj
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pydantic import BaseModel
from terms import range_of

from fakesss.lights import Light
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene

pytestmark = pytest.mark.gl

EXAMPLES = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
LEFT_OUT = {"object", "size", "lights", "rays"}
COSTLY = {  # fields that a picture's time depends on: small values only
    "supersampling": st.integers(1, 3),
    "map_size": st.none() | st.integers(16, 100),
    "faces": st.none() | st.integers(4, 2000),
    "samples": st.integers(1, 16).map(lambda quarter: 4 * quarter),
}
MESHES = [case for case in DRAWN.values() if case.content and case.name != "many-triangles"]


def limits_of(annotated: Any) -> list[Any]:
    """The bounds in an `Annotated`, which pydantic keeps in a field of their own."""
    return [limit for info in getattr(annotated, "__metadata__", ()) for limit in info.metadata]


def values(annotation: Any, limits: list[Any]) -> st.SearchStrategy[Any]:
    """Values of a field: over its whole range, its ends among them, small ones as often as large ones."""
    if get_origin(annotation) is Literal:
        return st.sampled_from(get_args(annotation))
    if get_origin(annotation) is tuple:
        return st.tuples(*[values(part.__origin__, limits_of(part)) for part in get_args(annotation)])
    if annotation is bool:
        return st.booleans()
    kinds = get_args(annotation)
    if type(None) in kinds:
        inner = kinds[0]
        plain = inner if get_origin(inner) is Literal else getattr(inner, "__origin__", inner)
        return st.none() | values(plain, [*limits_of(inner), *limits])
    low = max([bound.ge for bound in limits if isinstance(bound, Ge)], default=-1e9)
    low = max([np.nextafter(bound.gt, 1) for bound in limits if isinstance(bound, Gt)], default=low)
    high = min([bound.le for bound in limits if isinstance(bound, Le)], default=1e9)
    small = st.floats(-9, 9).map(lambda power: float(np.clip(10**power, low, high)))
    return st.floats(low, high) | small | st.sampled_from([float(low), float(high)])


def fields(model: type[BaseModel]) -> st.SearchStrategy[dict[str, Any]]:
    """Some of a model's fields, as in a file."""
    found = {}
    for name, field in model.model_fields.items():
        if name in LEFT_OUT:
            continue
        inner = field.annotation
        if name in COSTLY:
            found[name] = COSTLY[name]
        elif isinstance(inner, type) and issubclass(inner, BaseModel):
            found[name] = fields(inner)
        else:
            found[name] = values(inner, field.metadata)
    return st.fixed_dictionaries({}, optional=found)


NEWER = {"kernel", "resolution", "depth"}  # than the published style, which has none of them


def consistent(scene: dict[str, Any]) -> dict[str, Any]:
    """Without what the published style would be refused for."""
    if scene.get("style") != "as published":
        return scene
    tables = {name: scene[name] for name in ("blur", "layers") if name in scene}
    older = {name: {key: table[key] for key in table if key not in NEWER} for name, table in tables.items()}
    return {**{key: value for key, value in scene.items() if key != "quality"}, **older}


SCENES = st.builds(
    lambda scene, lights, size: {**consistent(scene), "lights": lights, "size": size},
    fields(Scene),
    st.lists(fields(Light), max_size=3),
    st.tuples(st.integers(1, 40), st.integers(1, 40)),
)


def check(renderer: Renderer, scene: Scene) -> None:
    """Every pixel is finite and within the terms."""
    image = renderer.render(scene).image
    assert np.isfinite(image).all()
    low, high = range_of(scene)
    background = np.array(scene.background)
    slack = 1e-5 * max(1.0, *np.abs(low), *high)
    assert (image[..., :3] >= np.minimum(low, background) - slack).all()
    assert (image[..., :3] <= np.maximum(high, background) + slack).all()
    thickness = renderer.data(scene, ("thickness",))["thickness"]
    assert np.isfinite(thickness).all() and thickness.min() >= 0 and thickness.max() <= 1


@EXAMPLES
@given(SCENES, st.sampled_from(MESHES))
def test_any_scene(renderer: Renderer, folder: Path, data: dict[str, Any], case: Any) -> None:
    try:
        scene = Scene.from_dict({**data, "object": case.write(folder)}, "any")
    except BadInput as refused:
        assert any(word in str(refused) for word in ("near", "attenuation")), "all else is within its range"
        return
    check(renderer, scene.replace({"occlusion.rays": 16, "layers.rays": 16}))


@EXAMPLES
@given(st.integers(0, 2**32 - 1), st.integers(3, 12), st.integers(1, 30), st.integers(0, 3))
def test_any_triangles(
    renderer: Renderer, tmp_path: Path, seed: int, vertices: int, triangles: int, digits: int
) -> None:
    """Few digits: vertices fall together, triangles lie in one plane, share edges, cross and repeat each other."""
    rng = np.random.default_rng(seed)
    positions = np.round(rng.normal(size=(vertices, 3)), digits)
    (tmp_path / "any.obj").write_bytes(obj((positions, rng.integers(0, vertices, (triangles, 3)))))
    renderer.bakes.clear()
    scene = Scene(object=str(tmp_path / "any.obj"), size=(32, 32), supersampling=1)
    try:
        check(renderer, scene.replace({"occlusion.rays": 16}))
    except BadInput as refused:
        assert "no triangle with an extent" in str(refused) or "no surface" in str(refused)
