import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

import fakesss.cli_picture  # noqa: F401  (adds its commands)
from fakesss.cli import commands
from fakesss.explanation import explained, saved
from fakesss.gpu import Gpu
from fakesss.inspect import compiled, explain
from fakesss.memory import peak_bytes
from fakesss.problem import BadInput
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
    local = {"material.thickness": "local", "layers.rays": 48}
    assert "48 rays a vertex" in next(line for line in text(local).splitlines() if line.startswith("  local_thickness"))


@pytest.mark.parametrize(
    ("name", "kind"),
    [("occlusion", "baked"), ("front", "drawn"), ("second", "chosen"), ("blur", "computed in place")],
)
def test_how_a_node_is_made_is_said(name: str, kind: str) -> None:
    line = next(line for line in text({}).splitlines() if line.startswith(f"  {name} "))
    assert line.split(maxsplit=1)[1].split(", ")[0] == kind


@pytest.mark.gl
def test_times_are_said_where_they_were_measured(gpu: Gpu) -> None:
    lines = text({}, timed=True, object="torus:4000", size=(32, 32)).splitlines()
    assert lines[0].endswith(" ms")
    assert " ms" in next(line for line in lines if line.startswith("  front "))
    assert " s" in next(line for line in lines if line.startswith("  mesh "))


def test_savings_in_words() -> None:
    row = {"effects": ["backlight", "blur"], "because": "material.backlight is 0", "forced_ms": 98.0}
    row |= {"saved_ms": 37.0, "noise_ms": 1.24}
    row |= {"bytes": 98_000_000, "forced_bytes": 117_000_000, "bake_seconds": 0.0, "same_bytes": True}
    lines = list(saved([json.loads(json.dumps(row))]))
    assert lines[1] == "  backlight, blur: material.backlight is 0"
    assert lines[2].strip() == "37.0 ± 1.2 of 98.0 ms, 19.0 of 117.0 MB; no byte of the picture changes"
    assert "THE PICTURE CHANGES" in list(saved([{**row, "same_bytes": False}]))[2]
    assert "2.00 s of baking once" in list(saved([{**row, "bake_seconds": 2.0}]))[2]
    assert list(saved(None)) == [] and "nothing" in list(saved([]))[1]


def test_the_command_prints_draws_and_refuses(tmp_path: Path) -> None:
    drawing = tmp_path / "graph.svg"
    done = CliRunner().invoke(commands, ["explain", "torus:4000", "-o", str(drawing)])
    assert done.exit_code == 0 and done.stdout.startswith("KEPT  ") and drawing.is_file()
    assert "SAVED" not in done.stdout
    source = CliRunner().invoke(commands, ["explain", "torus:4000", "--graph"])
    assert source.stdout.startswith("digraph frame {")
    refused = CliRunner().invoke(commands, ["explain", "torus:4000", "-o", "graph.gif"])
    assert isinstance(refused.exception, BadInput)


@pytest.mark.gl
def test_savings_are_in_the_document(gpu: Gpu) -> None:
    asked = ["explain", "torus:4000", "--size", "16x16", "--set", "material.backlight=0", "--savings", "--json"]
    document = json.loads(CliRunner().invoke(commands, asked).stdout)
    assert document.keys() == {"passes", "baked", "savings"}
    assert [row["effects"] for row in document["savings"]] == [["backlight", "blur"]]
