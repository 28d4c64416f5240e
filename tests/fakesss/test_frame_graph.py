"""Declaring and compiling need no GPU; running does."""

from collections.abc import Callable

import numpy as np
import pytest

from fakesss.frame import Frame, Run
from fakesss.frame_graph import DEPTH, Bake, Choice, FrameGraph, FrameGraphError, Pass, TextureSpec
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


def choosing(chosen: str, other: str) -> list[Pass | Choice]:
    return [node("a"), node("b"), Choice("either", chosen, "it is cheaper", {other: "it is dear"}), node("c", "either")]


def test_a_choice_keeps_what_it_chose_and_says_why() -> None:
    plan = FrameGraph(choosing("b_out", "a_out")).compile(["c_out"])
    assert {v.node.name: (v.kept, v.because) for v in plan.verdicts} == {
        "a": (False, "not read by either: it is dear"),
        "b": (True, "read by either"),
        "either": (True, "read by c; b_out: it is cheaper"),
        "c": (True, "c_out is asked for"),
    }
    assert [kept.name for kept in plan.kept] == ["b", "c"] and plan.root("either") == "b_out"
    assert plan.dead_after == {"b": (), "c": ("b_out",)}


@pytest.mark.gl
def test_a_choice_copies_nothing_and_can_be_asked_for(gpu: Gpu) -> None:
    gpu.pool.release()
    nodes = [Pass("a", paint(1), {"a_out": SPEC}), Pass("b", paint(2), {"b_out": SPEC})]
    graph = FrameGraph([*nodes, Choice("either", "b_out", "", {"a_out": ""})])
    np.testing.assert_array_equal(Run(graph.compile(["either"]), gpu, Recent(1))().values["either"], 2)
    assert len(gpu.pool.free[SPEC]) == 1


def merging(*more: Pass | Choice) -> FrameGraph:
    """A pass `soften` whose reader `shade` can compute it in place."""
    soften = Pass("soften", nothing, {"soft": SPEC}, ("a_out",), in_place=lambda inputs: ({}, {}))
    shade = Pass("shade", nothing, {"shaded": SPEC}, ("soft",), merges=("soft",))
    return FrameGraph([node("a"), soften, shade, *more])


def test_a_pass_with_one_reader_is_computed_there() -> None:
    plan = merging().compile(["shaded"])
    verdicts = {v.node.name: v for v in plan.verdicts}
    assert verdicts["soften"].merged and verdicts["soften"].because == "computed by shade, its only reader"
    assert plan.kept[-1].reads == ("a_out",) and [n.name for n in plan.kept] == ["a", "shade"]
    assert plan.passes == ("a", "soften", "shade")


def test_a_pass_with_two_readers_or_asked_for_is_drawn() -> None:
    for plan in (
        merging(node("other", "soft")).compile(["shaded", "other_out"]),
        merging().compile(["shaded", "soft"]),
    ):
        assert "soften" in [n.name for n in plan.kept]


@pytest.mark.gl
def test_a_mask_keeps_drawing_to_what_it_covers(gpu: Gpu) -> None:
    """A depth buffer that is written where the picture's left half is nearer than the far plane."""

    def half(frame: Frame) -> None:
        frame.target.clear(depth=0.5, viewport=(0, 0, 4, 4))

    def fill(frame: Frame) -> None:
        frame.fill("resolve.frag", {}, SAMPLES=1, AS_PUBLISHED=0)

    shape = TextureSpec((8, 4), 4)
    nodes = [
        Pass("front", half, {"colour": SPEC, "coverage": TextureSpec((8, 4), DEPTH)}, depth_test=True),
        Pass("white", lambda frame: frame.target.clear(1, 1, 1, 1), {"shaded": shape}),
        Pass("fill", fill, {"out": shape}, ("shaded", "coverage"), mask="coverage", clear=(0.25, 0, 0, 0)),
    ]
    out = Run(FrameGraph(nodes).compile(["out"]), gpu, Recent(1))().values["out"]
    np.testing.assert_array_equal(out[:, :4], 1)
    np.testing.assert_array_equal(out[:, 4:], np.broadcast_to([0.25, 0, 0, 0], (4, 4, 4)))


def test_the_drawing_shows_what_is_chosen_and_merged_as_kept() -> None:
    graph = merging(Choice("either", "shaded", "it is cheaper", {"a_out": "it is dear"}))
    drawn = graph.to_dot(graph.compile(["either"]))
    for name, shape in (("soften", "box"), ("shade", "box"), ("either", "diamond")):
        assert f'"{name}" [shape={shape} style=solid]' in drawn
    assert '"a" -> "either" [label="a_out" style=dashed]' in drawn


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
