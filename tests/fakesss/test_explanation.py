import json
from typing import Any

import pytest

from fakesss.explanation import explained, saved
from fakesss.gpu import Gpu
from fakesss.inspect import compiled, explain
from fakesss.memory import peak_bytes
from fakesss.scene import Scene


def text(changes: dict[str, Any], timed: bool = False, **fields: Any) -> str:
    scene = Scene(**fields).replace(changes)
    return "\n".join(explained(compiled(scene), explain(scene, timed)))


def test_every_node_is_named_once_under_its_verdict() -> None:
    kept, culled = text({"material.backlight": 0.0}).split("\nCULLED")
    plan = compiled(Scene().replace({"material.backlight": 0.0}))
    for verdict in plan.verdicts:
        part, other = (kept, culled) if verdict.kept else (culled, kept)
        named = f"\n  {verdict.node.name} "
        assert part.count(named) == 1 and named not in other
        assert verdict.because in part
    assert f"KEPT  {sum(verdict.kept for verdict in plan.verdicts)} of {len(plan.verdicts)}" in kept
    assert f"{peak_bytes(plan) / 1e6:.1f} MB of textures" in kept


def test_what_is_read_and_written_is_said() -> None:
    lines = text({}).splitlines()
    front = next(number for number, line in enumerate(lines) if line.startswith("  front "))
    assert lines[front + 2].strip() == "mesh, occlusion -> front, surface, coverage"
    assert "drawn, " in lines[front] and "MB" in lines[front] and " ms" not in "".join(lines)
    assert "320 rays a vertex" in next(line for line in lines if line.startswith("  occlusion"))


@pytest.mark.gl
def test_times_are_said_where_they_were_measured(gpu: Gpu) -> None:
    lines = text({}, timed=True, object="torus:4000", size=(32, 32)).splitlines()
    assert lines[0].endswith(" ms")
    assert " ms" in next(line for line in lines if line.startswith("  front "))
    assert " s" in next(line for line in lines if line.startswith("  mesh "))


def test_savings_in_words() -> None:
    row = {"effects": ["backlight", "blur"], "because": "material.backlight is 0", "ms": 61.0, "forced_ms": 98.0}
    row |= {"bytes": 98_000_000, "forced_bytes": 117_000_000, "bake_seconds": 0.0, "same_bytes": True}
    lines = list(saved([json.loads(json.dumps(row))]))
    assert lines[1] == "  backlight, blur: material.backlight is 0"
    assert lines[2].strip() == "37.0 of 98.0 ms, 19.0 of 117.0 MB; no byte of the picture changes"
    assert "THE PICTURE CHANGES" in list(saved([{**row, "same_bytes": False}]))[2]
    assert "2.00 s of baking once" in list(saved([{**row, "bake_seconds": 2.0}]))[2]
    assert list(saved(None)) == [] and "nothing" in list(saved([]))[1]
