"""What is kept for the next picture has a limit, and what is used again is not what was freed."""

from typing import Any

import moderngl
import numpy as np
import pytest

from fakesss import texture_pool
from fakesss.frame_graph import DEPTH, TextureSpec
from fakesss.gpu import Gpu
from fakesss.inspect import compiled
from fakesss.memory import peak_bytes
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.texture_pool import TexturePool

pytestmark = pytest.mark.gl
SPECS = [TextureSpec((64, 16 + side), 4) for side in range(4)]


@pytest.fixture
def pool(gpu: Gpu) -> TexturePool:
    """With room for two of `SPECS`."""
    return TexturePool(gpu.context, limit=2 * SPECS[-1].bytes)


def use(pool: TexturePool, spec: TextureSpec) -> Any:
    texture = pool.take(spec)
    pool.give_back(spec, texture)
    return texture


def is_freed(thing: Any) -> bool:
    return type(thing.mglo).__name__ == "InvalidObject"


def test_what_was_not_used_for_longest_is_freed(pool: TexturePool) -> None:
    first, second = use(pool, SPECS[0]), use(pool, SPECS[1])
    assert use(pool, SPECS[0]) is first
    third = use(pool, SPECS[2])
    assert [is_freed(texture) for texture in (first, second, third)] == [False, True, False]
    assert pool.held == SPECS[0].bytes + SPECS[2].bytes <= pool.limit


def test_depth_buffers_count_too(pool: TexturePool) -> None:
    """A renderbuffer and a texture may have the same number."""
    sizes = [(64, 64), (64, 65)]
    buffers = [pool.depth_buffer(size) for size in sizes]
    texture = use(pool, SPECS[0])
    assert [is_freed(thing) for thing in (*buffers, texture)] == [True, False, False]
    assert pool.held == TextureSpec(sizes[1], DEPTH).bytes + SPECS[0].bytes
    pool.release()
    assert pool.held == 0 and is_freed(texture) and is_freed(buffers[1])


def test_what_is_handed_out_is_never_freed(pool: TexturePool) -> None:
    taken = [pool.take(spec) for spec in SPECS]
    assert not any(map(is_freed, taken)) and pool.held == sum(spec.bytes for spec in SPECS)
    for spec, texture in zip(SPECS, taken, strict=True):
        pool.give_back(spec, texture)
    use(pool, TextureSpec((1, 1), 1))
    assert pool.held <= pool.limit


def test_a_framebuffer_goes_with_what_it_draws_into(pool: TexturePool) -> None:
    """The number of a texture is given again: a framebuffer found by it would draw into nothing."""
    for step in range(12):
        spec = SPECS[step % len(SPECS)]
        texture = pool.take(spec)
        pool.framebuffer([texture], pool.depth_buffer(spec.size)).clear(step, depth=1.0)
        drawn = np.frombuffer(texture.read(), np.float32)
        pool.give_back(spec, texture)
        assert drawn.size == spec.bytes // 4 and (drawn.reshape(-1, 4)[:, 0] == step).all()
    assert len(pool.framebuffers) <= 2


class Full:
    """A context whose memory is full."""

    def texture(self, *args: Any, **kwargs: Any) -> Any:
        raise moderngl.Error("cannot create texture")


def test_what_could_not_be_made_is_not_counted() -> None:
    pool = TexturePool(Full())
    with pytest.raises(moderngl.Error):
        pool.take(SPECS[0])
    assert pool.held == 0


SWEEP: list[dict[str, Any]] = [
    {},
    *({"light.shadows": True, "shadow.map_size": side} for side in (64, 512, 100, 700, 300, 128)),
    *({"lights": [{"azimuth": 30.0 * turn, "shadows": True} for turn in range(number)]} for number in (1, 5, 2, 9)),
    {"light.shadows": True, "light.kind": "point", "light.distance": 0.5},
    {"layers.method": "peel"},
    {"material.thickness": "bridged", "light.shadows": True},
    {"material.backlight": 0.0},
]


@pytest.mark.parametrize("timed", [False, True])
def test_a_sweep_takes_no_more_than_its_pictures_say(
    renderer: Renderer, monkeypatch: pytest.MonkeyPatch, timed: bool
) -> None:
    """With nothing allowed beyond need, at no time more than `explain` tells of the picture that is drawn."""
    pool = renderer.gpu.pool
    monkeypatch.setattr(texture_pool, "KEPT", 0)
    most: list[int] = []
    take = TexturePool.take

    def noting(self: TexturePool, spec: TextureSpec) -> Any:
        texture = take(self, spec)
        most.append(self.held)
        return texture

    monkeypatch.setattr(TexturePool, "take", noting)
    scene = Scene(object="torus:4000", size=(60, 44))
    renderer.render(scene.replace({"size": (8, 8)}))
    for changes in (*SWEEP, *reversed(SWEEP)):
        most.clear()
        renderer.render(scene.replace(changes), timed=timed)
        assert max([*most, pool.held]) <= peak_bytes(compiled(scene.replace(changes))), changes


def test_pictures_are_the_same_with_little_and_with_much_room(
    renderer: Renderer, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = Scene(object="torus:4000", size=(60, 44))
    before = [renderer.render(scene.replace(changes)).image.tobytes() for changes in SWEEP]
    monkeypatch.setattr(texture_pool, "KEPT", 0)
    assert [renderer.render(scene.replace(changes)).image.tobytes() for changes in SWEEP] == before
