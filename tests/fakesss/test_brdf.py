"""Every GLSL term beside its numpy twin on random inputs, drawn through a small test shader."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from fakesss import brdf, camera, colour, illumination
from fakesss.gpu import Gpu
from fakesss.shader_source import GLSL, Programs
from fakesss.shadow_maps import SIDES, cube_side, slope_bias

COUNT = 4096
TERM = """#include "{file}"
uniform sampler2D inputs;
out vec4 value;
void main() {{
    vec4 x = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0);
    value = vec4({expression});
}}
"""


def on_gpu(gpu: Gpu, folder: Path, file: str, expression: str, inputs: NDArray[np.float32]) -> NDArray[np.float32]:
    """The GLSL expression over rows (N, 4) of inputs `x`: (N,) float32."""
    for path in GLSL.iterdir():
        (folder / path.name).write_text(path.read_text())
    (folder / "term.frag").write_text(TERM.format(file=file, expression=expression))
    program = Programs(gpu.context, folder).get("fullscreen.vert", "term.frag")
    source = gpu.context.texture((len(inputs), 1), 4, np.ascontiguousarray(inputs).tobytes(), dtype="f4")
    target = gpu.context.texture((len(inputs), 1), 4, dtype="f4")
    framebuffer = gpu.context.framebuffer([target])
    framebuffer.use()
    source.use(0)
    gpu.context.vertex_array(program, []).render(vertices=3)
    return np.frombuffer(target.read(), np.float32).reshape(-1, 4)[:, 0]


def uniform(seed: int, *ranges: tuple[float, float]) -> NDArray[np.float32]:
    """(COUNT, 4) inputs; columns without a range are 0. Every range's ends are among them."""
    generator = np.random.default_rng(seed)
    inputs = np.zeros((COUNT, 4), np.float32)
    for column, (low, high) in enumerate(ranges):
        inputs[:, column] = generator.uniform(low, high, COUNT)
        ends = np.array([low, high], np.float32)[generator.integers(0, 2, 64)]
        inputs[generator.integers(0, COUNT, 64), column] = ends
    return inputs


TERMS = [
    ("lambert", "common_brdf.glsl", "lambert(x.x)", [(-1, 1)], lambda x: brdf.lambert(x[0])),
    (
        "backlight",
        "common_brdf.glsl",
        "backlight(x.x, x.y)",
        [(-0.5, 1.5), (0, 60)],
        lambda x: brdf.backlight(x[0], x[1]),
    ),
    (
        "blinn_phong",
        "common_brdf.glsl",
        "blinn_phong(x.x, x.y, x.z)",
        [(-1, 1), (-1, 1), (0, 60)],
        lambda x: brdf.blinn_phong(x[0], x[1], x[2]),
    ),
    (
        "nonlinear_depth",
        "common_depth.glsl",
        "nonlinear_depth(x.x, vec2(1.0, 3.0))",
        [(1.5, 3)],
        lambda x: camera.nonlinear_depth(x[0], 1.0, 3.0),
    ),
    (
        "linear_depth",
        "common_depth.glsl",
        "linear_depth(x.x, vec2(1.0, 3.0))",
        [(0, 1)],
        lambda x: camera.linear_depth(x[0], 1.0, 3.0),
    ),
    (
        "attenuation",
        "common_light.glsl",
        "attenuation(x.x, x.yzw)",
        [(0, 10), (0, 1), (0, 1), (0, 1)],
        lambda x: illumination.attenuation(x[0], (x[1], x[2], x[3])),
    ),
    (
        "spot_exponent",
        "common_light.glsl",
        "spot_exponent(x.x, x.y, x.z)",
        [(0, 2), (1e-6, 1), (0, 60)],
        lambda x: illumination.spot_exponent(x[0], x[1], x[2]),
    ),
    (
        "spot_linear",
        "common_light.glsl",
        "spot_linear(x.x, x.y)",
        [(0, 2), (0.1, 1)],
        lambda x: illumination.spot_linear(x[0], x[1]),
    ),
    ("slope_bias", "common_shadow.glsl", "slope_bias(x.x, x.y)", [(0, 0.1), (0, 1)], lambda x: slope_bias(x[0], x[1])),
    ("cube_side", "common_shadow.glsl", "cube_side(x.xyz)", [(-1, 1)] * 3, lambda x: cube_side(x[:3].T)),
    (
        "ahead",
        "common_shadow.glsl",
        "dot(ahead(x.xyz, cube_side(x.xyz)), vec3(1.0, 10.0, 100.0))",
        [(-1, 1)] * 3,
        lambda x: np.einsum("nij,nj->ni", SIDES[cube_side(x[:3].T)], x[:3].T) @ [1, 10, 100],
    ),
    ("decode_srgb", "common_colour.glsl", "decode_srgb(x.xxx).x", [(0, 1)], lambda x: colour.decode_srgb(x[0])),
]


@pytest.mark.gl
@pytest.mark.parametrize(("name", "file", "expression", "ranges", "twin"), TERMS, ids=[term[0] for term in TERMS])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_glsl_agrees_with_numpy(gpu, tmp_path, name, file, expression, ranges, twin, seed) -> None:  # type: ignore[no-untyped-def]
    inputs = uniform(seed, *ranges)
    drawn = on_gpu(gpu, tmp_path, file, expression, inputs)
    np.testing.assert_allclose(drawn, twin(inputs.T.astype(np.float64)), rtol=1e-5, atol=1e-30)


@pytest.mark.gl
def test_large_exponents_stay_within_float32s_own_conditioning(gpu: Gpu, tmp_path: Path) -> None:
    inputs = uniform(7, (0, 1), (0, 1e4))
    drawn = on_gpu(gpu, tmp_path, "common_brdf.glsl", "power(x.x, x.y)", inputs)
    exact = brdf.power(inputs[:, 0], inputs[:, 1])
    assert np.isfinite(drawn).all()
    # relative error grows with the exponent as rounding of the logarithm does; below 1e-30 the result may flush to 0
    assert (np.abs(drawn - exact) <= exact * (1e-5 + 2e-7 * inputs[:, 1]) + 1e-30).all()


@pytest.mark.gl
@pytest.mark.parametrize("base", [0.0, 1e-40, 0.5, 1.0])
@pytest.mark.parametrize("exponent", [0.0, 1e-3, 1.0, 1e4, 1e5])
def test_power_is_finite_where_glsl_leaves_it_open(gpu: Gpu, tmp_path: Path, base: float, exponent: float) -> None:
    drawn = on_gpu(gpu, tmp_path, "common_brdf.glsl", "power(x.x, x.y)", np.array([[base, exponent, 0, 0]], np.float32))
    assert np.isfinite(drawn[0]) and 0 <= drawn[0] <= 1
    assert exponent != 0 or drawn[0] == 1
    assert base != 1 or drawn[0] == pytest.approx(1, rel=1e-6)


UNIT = st.floats(0, 1)


@given(UNIT, UNIT, st.floats(0, 1e5))
def test_backlight_is_bounded_and_never_brighter_where_thicker(t1: float, t2: float, exponent: float) -> None:
    thin, thick = sorted((t1, t2))
    assert 0 <= brdf.backlight(thick, exponent) <= brdf.backlight(thin, exponent) <= 1


@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(0, 1e5))
def test_no_highlight_on_the_side_away_from_the_light(n_dot_l: float, n_dot_h: float, shininess: float) -> None:
    value = brdf.blinn_phong(n_dot_l, n_dot_h, shininess)
    assert value == 0 if n_dot_l <= 0 else 0 <= value <= 1


def test_zero_to_the_zero_is_one() -> None:
    assert brdf.power(0, 0) == 1 and brdf.power(0, 1e-3) == 0
    assert brdf.backlight(1, 0) == 1
