"""Texture memory counted from a plan against that of a pool that drew it."""

from typing import Any

import pytest

from fakesss.frame_graph import DEPTH, Bake, FrameGraph, Pass, TextureSpec
from fakesss.inspect import compiled
from fakesss.memory import peak_bytes, written_bytes
from fakesss.renderer import Renderer
from fakesss.scene import Scene

ONE, FOUR = TextureSpec((8, 4), 1), TextureSpec((8, 4), 4)
PLANE = 8 * 4 * 4  # bytes of one float32 channel


def drawn(name: str, reads: tuple[str, ...], depth_test: bool = False, **writes: TextureSpec) -> Pass:
    return Pass(name, lambda frame: None, writes, reads, depth_test=depth_test)


def test_a_texture_is_used_again_after_its_last_reader() -> None:
    chain = [drawn("a", (), a=ONE), drawn("b", ("a",), b=ONE), drawn("c", ("b",), c=ONE), drawn("d", ("c",), d=ONE)]
    assert peak_bytes(FrameGraph(chain).compile(["d"])) == 2 * PLANE
    chain[3] = drawn("d", ("c", "a"), d=ONE)  # keeps `a` to the end
    assert peak_bytes(FrameGraph(chain).compile(["d"])) == 3 * PLANE


def test_sizes_do_not_mix_and_own_depth_buffers_are_shared() -> None:
    nodes = [
        Bake("mesh", lambda inputs: None, lambda inputs: 0),
        drawn("a", ("mesh",), depth_test=True, a=FOUR),
        drawn("b", ("mesh",), depth_test=True, b=ONE),
        drawn("c", ("a", "b"), c=ONE, z=TextureSpec((8, 4), DEPTH)),
        drawn("never", (), never=FOUR),
    ]
    plan = FrameGraph(nodes).compile(["c"])
    assert peak_bytes(plan) == (4 + 1 + 1 + 1 + 1) * PLANE
    assert [written_bytes(node) for node in plan.kept] == [0, 4 * PLANE, PLANE, 2 * PLANE]


@pytest.mark.gl
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"material.backlight": 0.0},
        {"layers.method": "peel", "blur.enabled": False},
        {"material.thickness": "bridged"},
        {"material.thickness": "total-path"},
        {"supersampling": 1, "occlusion.method": "screen-space"},
        {"layers.depth": "float16"},
        {"layers.resolution": 2, "size": (61, 43)},
        {"layers.resolution": 4, "blur.kernel": "separable", "layers.depth": "float16"},
        {"layers.resolution": 2, "blur.enabled": False},
        {"blur.kernel": "separable"},
        {"light.shadows": True, "light.kind": "point", "light.distance": 0.5, "shadow.map_size": 33},
    ],
    ids=str,
)
def test_the_count_is_what_the_pool_holds(renderer: Renderer, changes: dict[str, Any]) -> None:
    scene = Scene(object="torus:4000", size=(60, 44)).replace(changes)
    renderer.gpu.drawn.clear()
    renderer.gpu.pool.release()
    renderer.render(scene)
    assert peak_bytes(compiled(scene)) == renderer.gpu.pool.held
