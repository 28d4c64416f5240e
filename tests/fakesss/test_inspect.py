import subprocess
import sys

import numpy as np
import pytest

from fakesss.gpu import Gpu
from fakesss.inspect import contact_sheet, explain, graph
from fakesss.scene import Scene

PASS = {"name", "kept", "because", "reads", "writes", "gpu_ms"}
BAKED = {"name", "kept", "because", "rays", "seconds", "cached"}


def test_explain_has_the_contracts_shape() -> None:
    document = explain(Scene().replace({"occlusion.rays": 16, "layers.rays": 48}))
    assert document.keys() == {"passes", "baked"}
    assert all(entry.keys() == PASS for entry in document["passes"])
    assert all(entry.keys() == BAKED for entry in document["baked"])
    rays = {entry["name"]: entry["rays"] for entry in document["baked"]}
    assert rays == {"mesh": None, "occlusion": 16, "local_thickness": 48, "coarse_mesh": None}
    assert {entry["gpu_ms"] for entry in document["passes"]} == {None}


def test_explain_opens_no_context() -> None:
    code = "from fakesss import Scene, gpu, inspect; inspect.explain(Scene()); assert not hasattr(gpu._threads, 'gpu')"
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.gl
def test_explain_measures_when_asked(gpu: Gpu) -> None:
    document = explain(Scene(object="sphere:4000", size=(64, 64)), timed=True)
    timed = {entry["name"] for entry in document["passes"] if entry["gpu_ms"] is not None}
    assert timed == {"front", "back_faces", "shade", "resolve"}  # the others are culled, chosen or computed in place
    assert all(0 <= entry["gpu_ms"] < 1e4 for entry in document["passes"] if entry["name"] in timed)
    for entry in document["baked"]:
        assert entry["kept"] == (entry["name"] in ("mesh", "occlusion"))
        assert not entry["kept"] or (entry["seconds"] >= 0 and entry["cached"] in (True, False))


def test_the_drawn_graph_dashes_what_is_culled() -> None:
    text = graph(Scene().replace({"material.backlight": 0.0}))
    assert '"blur" [shape=box style=dashed]' in text and '"shade" [shape=box style=solid]' in text


@pytest.mark.gl
@pytest.mark.parametrize("size", [(64, 64), (317, 211), (1, 1), (3, 200)])
def test_contact_sheet_of_any_size(gpu: Gpu, size: tuple[int, int]) -> None:
    sheet = contact_sheet(Scene(object="sphere:4000", size=size))
    assert sheet.ndim == 3 and sheet.shape[2] == 3
    assert np.isfinite(sheet).all() and sheet.min() >= 0 and sheet.max() <= 1


@pytest.mark.gl
def test_contact_sheet_of_an_empty_view(gpu: Gpu) -> None:
    sheet = contact_sheet(Scene(object="sphere:4000", size=(32, 32)).replace({"camera.near": 50.0, "camera.far": 60.0}))
    assert np.isfinite(sheet).all()
