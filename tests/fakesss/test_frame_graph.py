"""Declaring and compiling need no GPU; running does."""

from collections.abc import Callable

import numpy as np
import pytest

from fakesss.frame import Frame, Run
from fakesss.frame_graph import Bake, FrameGraph, FrameGraphError, Pass, TextureSpec
from fakesss.gpu import Gpu
from fakesss.recent import Recent

SPEC = TextureSpec((8, 4), 1)


def nothing(frame: Frame) -> None:
    pass


def paint(value: float) -> Callable[[Frame], None]:
    return lambda frame: frame.target.clear(value)


def node(name: str, *reads: str, **unread: str) -> Pass:
    return Pass(name, nothing, {f"{name}_out": SPEC}, reads, unread)


def test_keeps_what_the_target_depends_on_and_says_why() -> None:
    graph = FrameGraph(
        [
            Bake("mesh", make=lambda inputs: 1, key=lambda inputs: 1),
            node("layer", "mesh"),
            node("soften", "layer_out"),
            node("shade", "mesh", soften_out="weight is 0"),
        ]
    )
    verdicts = {v.node.name: (v.kept, v.because) for v in graph.compile(["shade_out"]).verdicts}
    assert verdicts == {
        "mesh": (True, "read by shade"),
        "layer": (False, "read only by soften, which is culled"),
        "soften": (False, "not read by shade: weight is 0"),
        "shade": (True, "shade_out is asked for"),
    }
    assert '"soften" [shape=box style=dashed]' in graph.to_dot(graph.compile(["shade_out"]))


def test_a_resource_dies_after_its_last_reader() -> None:
    plan = FrameGraph([node("a"), node("b", "a_out"), node("c", "a_out", "b_out")]).compile(["c_out"])
    assert plan.dead_after == {"a": (), "b": (), "c": ("a_out", "b_out")}


@pytest.mark.parametrize(
    ("nodes", "sentence"),
    [
        ([node("a", "later_out"), node("later")], 'pass "a" reads "later_out", which nothing before it writes'),
        ([node("a"), node("a")], 'two passes are named "a"'),
        ([node("a"), Pass("b", nothing, {"a_out": SPEC})], 'pass "b" writes "a_out", already written by "a"'),
    ],
)
def test_a_graph_that_cannot_run_cannot_be_declared(nodes: list[Pass], sentence: str) -> None:
    with pytest.raises(FrameGraphError, match=sentence):
        FrameGraph(nodes)


def test_an_unknown_target_names_those_there_are() -> None:
    with pytest.raises(FrameGraphError, match=r'"x" is written by no pass; there are a_out'):
        FrameGraph([node("a")]).compile(["x"])


@pytest.mark.gl
def test_a_culled_bake_never_runs_and_a_kept_one_runs_once(gpu: Gpu) -> None:
    made: list[str] = []
    graph = FrameGraph(
        [
            Bake("wanted", make=lambda inputs: made.append("wanted"), key=lambda inputs: 1),
            Bake("unwanted", make=lambda inputs: made.append("unwanted"), key=lambda inputs: 1),
            Pass("show", paint(0.5), {"picture": SPEC}, ("wanted",)),
        ]
    )
    bakes: Recent[object] = Recent(4)
    first = Run(graph.compile(["picture"]), gpu, bakes)()
    second = Run(graph.compile(["picture"]), gpu, bakes, timed=True)()
    assert made == ["wanted"]
    assert (first.baked["wanted"].cached, second.baked["wanted"].cached) == (False, True)
    assert first.gpu_ms == {} and second.gpu_ms.keys() == {"show"}
    np.testing.assert_array_equal(second.values["picture"], np.full((4, 8), 0.5, np.float32))


@pytest.mark.gl
def test_textures_are_shared_when_their_lives_do_not_overlap(gpu: Gpu) -> None:
    gpu.pool.release()
    chain = [Pass("p0", paint(0), {"r0": SPEC})]
    chain += [Pass(f"p{i}", paint(i), {f"r{i}": SPEC}, (f"r{i - 1}",)) for i in range(1, 6)]
    values = Run(FrameGraph(chain).compile(["r5"]), gpu, Recent(1))().values
    assert len(gpu.pool.free[SPEC]) == 2
    np.testing.assert_array_equal(values["r5"], 5)


@pytest.mark.gl
def test_an_exception_in_a_draw_gives_every_texture_back(gpu: Gpu) -> None:
    def fail(frame: Frame) -> None:
        raise RuntimeError("driver says no")

    gpu.pool.release()
    graph = FrameGraph([Pass("a", paint(1), {"x": SPEC}), Pass("b", fail, {"y": SPEC}, ("x",))])
    for _ in range(3):
        with pytest.raises(RuntimeError, match="driver says no"):
            Run(graph.compile(["y"]), gpu, Recent(1))()
    assert len(gpu.pool.free[SPEC]) == 2


@pytest.mark.gl
def test_a_pooled_texture_comes_back_with_fresh_sampler_state_and_contents(gpu: Gpu) -> None:
    import moderngl

    def spoil(frame: Frame) -> None:
        frame.target.clear(7.0)
        texture = frame.target.color_attachments[0]
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.repeat_x = True
        texture.swizzle = "1111"

    gpu.pool.release()
    Run(FrameGraph([Pass("a", spoil, {"x": SPEC})]).compile(["x"]), gpu, Recent(1))()
    texture = gpu.pool.take(SPEC)
    assert (texture.filter, texture.repeat_x, texture.swizzle) == ((moderngl.NEAREST,) * 2, False, "RGBA")
    gpu.pool.give_back(SPEC, texture)
    values = Run(FrameGraph([Pass("a", nothing, {"x": SPEC})]).compile(["x"]), gpu, Recent(1))().values
    np.testing.assert_array_equal(values["x"], 0)


@pytest.mark.gl
def test_framebuffers_are_reused(gpu: Gpu) -> None:
    gpu.pool.release()
    graph = FrameGraph([Pass("a", paint(1), {"x": SPEC}, depth_test=True)])
    for _ in range(5):
        Run(graph.compile(["x"]), gpu, Recent(1))()
    assert len(gpu.pool.framebuffers) == 1
