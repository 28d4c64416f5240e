"""The benchmark measures what it says it does; its figures are no test's business."""

import numpy as np
import pytest

from fakesss.bench import SIZE, bench, in_turn
from fakesss.bench_bake import bake_times, prepared
from fakesss.bench_tables import tables
from fakesss.direct_light import DirectLight
from fakesss.occlusion import bake_occlusion, cast_rays
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.shapes import load_object

CONTRACT = {"object", "faces", "direct_ms", "technique_ms", "ratio", "bvh_ms", "ao_seconds", "ao_mrays_per_s"}


@pytest.mark.gl
def test_the_yardstick_draws_the_same_direct_light(renderer: Renderer) -> None:
    scene = Scene(object="torus:8000", size=(160, 120), supersampling=1).replace({"material.backlight": 0.0})
    mesh = load_object(scene.object)
    direct = DirectLight(renderer.gpu, scene, mesh, bake_occlusion(mesh).values)
    ours = renderer.render(scene).image[..., :3]
    for cull in (True, False):
        direct(cull)
        difference = np.abs(direct.image() - np.minimum(ours, 1))
        assert np.percentile(difference, 99.9) < 0.6 / 255 and difference.max() < 0.05
    assert (ours != np.float32(scene.background)).any(axis=2).mean() > 0.2


@pytest.mark.gl
def test_the_document_is_the_contracts(renderer: Renderer) -> None:
    result = bench("sphere", (1000,), size=(48, 48), repeats=1)
    assert result.keys() == {"machine", "rows", "method"}
    (row,) = result["rows"]
    assert row.keys() >= CONTRACT
    assert row["ratio"] == row["technique_ms"] / row["direct_ms"]
    assert row["largest_difference"] <= 1
    assert all(value > 0 for name, value in row.items() if name not in ("object", "largest_difference"))
    assert f"{row['faces']:,}" in tables(result) and "0/255" in tables(result)


@pytest.mark.gl
@pytest.mark.parametrize("name", ["figure", "knot", "hand", "head", "relief", "shell"])
def test_the_exact_technique_is_drawn_without_loss(renderer: Renderer, name: str) -> None:
    """Short cuts against the peeled, unmerged path, at the size of the benchmark."""
    from fakesss.bench import largest_difference

    scene = Scene(object=f"{name}:30000", size=SIZE, supersampling=1)
    assert largest_difference(renderer, scene, load_object(scene.object)) <= 1


def test_ways_are_timed_in_turn_and_the_first_rounds_do_not_count() -> None:
    calls: list[str] = []
    times = in_turn({"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}, 3)
    assert calls == ["a", "b"] * 5 and times.keys() == {"a", "b"}


def test_bare_rays_are_those_of_the_bake() -> None:
    mesh = load_object("sphere:1000")
    ready = prepared(mesh, 20)
    _, cast = cast_rays(mesh, 20, "cosine")
    assert sum(len(origins) for origins, _, _ in ready) == cast
    times = bake_times(mesh, 20, 1)
    assert times["ao_mrays_per_s"] == pytest.approx(cast / 1e6 / (times["ao_seconds"] - times["bvh_ms"] / 1e3))
