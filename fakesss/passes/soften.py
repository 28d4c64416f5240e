"""The parts of the softening that cannot be done in place by whoever reads its result.

A separable kernel goes along the rows first. A second layer at every n-th sample is softened there, at 1/n^2 of the
cost, before it is brought to all samples.
"""

from typing import Any

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass
from fakesss.passes.layer import layer
from fakesss.passes.sparse import why_not_sparse
from fakesss.softening import KERNELS, Kernel
from fakesss.sparse_layer import placing, sparse_size

EXACT = "takes the taps that `blur.kernel` says, a knob of the module blur"

PUBLISHED_STEP = 1 / 256  # of the viewport, thesis appendix C.2.1
PUBLISHED_RANGE = 0.10  # of non-linear depth, thesis eq. C.1


def kernel_of(setting: Setting) -> Kernel:
    """The softening's taps."""
    return KERNELS[setting.scene.blur.kernel]


def tap_uniforms(setting: Setting, every: int = 1) -> dict[str, Any]:
    """Those of `glsl/common_blur.glsl`, for a layer with every n-th sample.

    Where n does not divide the picture, such a layer's texture is wider than the picture, and a tap a smaller share.
    """
    view, settings = setting.view, setting.scene.blur
    if setting.published:
        step, depths = (PUBLISHED_STEP, PUBLISHED_STEP), {"clip": (view.near, view.far), "distance": view.distance}
        return {"tap": step, "depth_range": PUBLISHED_RANGE, **depths}
    tap = view.in_picture(2 * settings.step * kernel_of(setting).spacing)
    scale = placing(setting.size, every)["scale"]
    return {"tap": (tap[0] * scale[0], tap[1] * scale[1]), "depth_range": 2 * settings.depth_range}


def tap_defines(setting: Setting, second_step: bool) -> dict[str, int]:
    """The permutation of `glsl/common_blur.glsl`; `second_step`: the column that follows a separable kernel's row."""
    kernel = kernel_of(setting)
    axes = {"ROWS": int(second_step), "COLUMNS": int(not second_step)} if kernel.separable else {}
    return {"TAPS": kernel.taps, "SECOND_STEP": int(second_step), **axes}


def soften_across(setting: Setting) -> Pass:
    """Reads the second layer; writes `softened_across`: the same, softened along each row."""
    sparse = not why_not_sparse(setting)
    source, mask = ("sparse_back", "sparse_coverage") if sparse else ("second", "coverage")
    return soften_pass(setting, "soften_across", source, mask, "softened_across", second_step=False)


def soften(setting: Setting) -> Pass:
    """Reads the sparse second layer, or what `soften_across` left of it; writes `softened`, as sparse."""
    separable = kernel_of(setting).separable
    source = "softened_across" if separable else "sparse_back"
    return soften_pass(setting, "soften", source, "sparse_coverage", "softened", second_step=separable)


def soften_pass(setting: Setting, name: str, source: str, mask: str, target: str, second_step: bool) -> Pass:
    """A full-screen pass over the samples that `mask` covers."""
    every = setting.scene.layers.resolution if mask == "sparse_coverage" else 1
    size = sparse_size(setting.size, every)
    renamed = {source: "softened_across" if second_step else "second"}

    def draw(frame: Frame) -> None:
        uniforms = {**tap_uniforms(setting, every), "size": size}
        frame.fill("soften.frag", uniforms, renamed, **tap_defines(setting, second_step))

    return Pass(name, draw, reads=(source, mask), writes={target: layer(setting, size)}, mask=mask)
