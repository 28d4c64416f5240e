"""The context, and what a user is told where there is none."""

import subprocess
import sys
import threading
from typing import Any

import moderngl
import pytest

from fakesss.gpu import Gpu, renderer_facts, reporting_memory, shared, warm_up_timer
from fakesss.inspect import compiled
from fakesss.problem import BadInput
from fakesss.renderer import Renderer, what_takes_most
from fakesss.scene import Scene

ASK = """
import sys
from fakesss.gpu import shared
from fakesss.problem import BadInput
try:
    shared()
except BadInput as error:
    print(error)
    sys.exit(2)
"""
NO_DRIVER = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "LIBGL_DRIVERS_PATH": "/nonexistent"}


@pytest.mark.gl
def test_without_a_driver_one_sentence_names_the_mend(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in NO_DRIVER.items():
        monkeypatch.setenv(name, value)
    run = subprocess.run([sys.executable, "-c", ASK], capture_output=True, text=True, check=False)
    assert run.returncode == 2, run.stderr
    assert run.stdout.count("\n") == 1
    assert run.stdout.startswith("OpenGL: no off-screen context (")
    assert "apt-get install libegl1 libgl1" in run.stdout


@pytest.mark.gl
def test_one_context_per_thread(gpu: Gpu) -> None:
    others: list[Gpu] = []
    thread = threading.Thread(target=lambda: others.append(shared()))
    thread.start()
    thread.join()
    assert shared() is gpu and others[0] is not gpu


@pytest.mark.gl
def test_facts_for_the_manifest(gpu: Gpu) -> None:
    facts = renderer_facts()
    assert facts.keys() == {"gl_renderer", "gl_version"} and all(facts.values())
    assert gpu.context.version_code >= 330


@pytest.mark.gl
def test_a_fresh_contexts_first_times_are_plausible(gpu: Gpu) -> None:
    times: list[int] = []
    thread = threading.Thread(target=lambda: times.append(warm_up_timer(shared().context)))
    thread.start()
    thread.join()
    assert 0 <= times[0] < 1e9


@pytest.mark.gl
@pytest.mark.parametrize("said", ["cannot create texture", "the framebuffer is not complete (INCOMPLETE_ATTACHMENT)"])
def test_what_does_not_fit_is_one_sentence(said: str) -> None:
    """The second is how Mesa refuses 5000x5000 pixels at supersampling 3."""
    expected = pytest.raises(BadInput, match=r"5000x5000 pixels do not fit .*; lower size")
    with expected, reporting_memory("5000x5000 pixels", "lower size"):
        raise moderngl.Error(said)


@pytest.mark.parametrize(
    ("changes", "what", "mend"),
    [
        ({}, "512x512 pixels with supersampling 3", "size or supersampling"),
        ({"light.shadows": True}, "512x512 pixels with supersampling 3", "size or supersampling"),
        ({"light.shadows": True, "shadow.map_size": 16384}, "shadow maps of 16384x16384 texels", "shadow.map_size or"),
        ({"shadow.map_size": 16384}, "512x512 pixels with supersampling 3", "size or supersampling"),
    ],
    ids=str,
)
def test_what_takes_most_memory_is_named(changes: dict[str, Any], what: str, mend: str) -> None:
    scene = Scene(object="sphere:4000").replace(changes)
    named, lower = what_takes_most(compiled(scene), scene, scene.supersampling)
    assert named == what and mend in lower


@pytest.mark.gl
def test_shadow_maps_are_held_to_what_this_opengl_has(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene(object="sphere:4000", size=(16, 16)).replace({"light.shadows": True, "shadow.map_size": 2048})
    assert renderer.render(scene).non_finite == 0
    monkeypatch.setattr(renderer, "largest_texture", 1024)
    with pytest.raises(BadInput, match=r"shadow\.map_size: .* 2048x2048 texels, this OpenGL has 1024 a side; lower"):
        renderer.render(scene)
