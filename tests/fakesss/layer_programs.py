"""Full-screen shaders of depth layers, run on layers that no object has."""

from collections.abc import Mapping
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from fakesss.gpu import Gpu
from fakesss.shader_source import feed

Floats = NDArray[np.float32]


def filled(
    gpu: Gpu,
    fragment: str,
    layers: Mapping[str, Floats],
    uniforms: Mapping[str, Any],
    size: tuple[int, int],
    **defines: int,
) -> Floats:
    """What `fragment` writes at every sample of `size`, (H, W), bottom row first like the `layers` by their names."""
    program = gpu.programs.get("fullscreen.vert", fragment, defines)
    context = gpu.context
    textures = [
        context.texture(layer.shape[::-1], 1, np.float32(layer).tobytes(), dtype="f4") for layer in layers.values()
    ]
    for unit, texture in enumerate(textures):
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        texture.repeat_x = texture.repeat_y = False
        texture.use(unit)
    feed(program, {**uniforms, **{name: unit for unit, name in enumerate(layers)}})
    target = context.texture(size, 1, dtype="f4")
    framebuffer = context.framebuffer([target])
    scope = context.scope(framebuffer, moderngl.NOTHING)
    triangle = context.vertex_array(program, [])
    with scope:
        triangle.render(vertices=3)
    values = np.frombuffer(target.read(), np.float32).reshape(size[::-1])
    for thing in (scope, triangle, framebuffer, target, *textures):
        thing.release()
    return values


def random_layer(rng: np.random.Generator, size: tuple[int, int]) -> Floats:
    """(H, W) depths of 1..3 radii, in steps and slopes, a fifth of it empty."""
    height, width = size[::-1]
    y, x = np.mgrid[:height, :width]
    slope = rng.uniform(-0.05, 0.05, 2)
    steps = rng.choice(rng.uniform(1.2, 2.8, 4), (height, width))
    depth = np.clip(steps + slope[0] * x + slope[1] * y, 1, 3)
    return np.where(rng.random((height, width)) < 0.2, 0, depth).astype(np.float32)
