"""Thickness to a softened second layer, so that its edges do not show through as hard lines."""

from collections.abc import Mapping
from typing import Any

from fakesss.calls import Setting, as_published, no_thickness
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.knob import Knob, Level, culled, first_of
from fakesss.passes.soften import kernel_of, tap_defines, tap_uniforms
from fakesss.passes.sparse import upsampling, why_not_sparse
from fakesss.passes.thickness import open_thickness

NONE = Level("none", {"blur.enabled": False})
SOFTENED = [Level(name, {"blur.enabled": True, "blur.kernel": name}) for name in ("3x3", "separable", "5x5", "9x9")]
KNOBS = (
    Knob(
        name="blur kernel",
        levels=(NONE, *SOFTENED),
        reference=SOFTENED[-1],
        error="how soft the second layer's edges are",
        unused=first_of(no_thickness, as_published, culled("blur")),
        beside="5x5",  # the default, with which other layers are judged as they are used
    ),
)


def blur(setting: Setting) -> Pass:
    """Writes `blurred_thickness` (0..1); the shading can compute it in place.

    Reads `mesh`, `front` and what is to be softened: `second`, or `softened_across` where the rows are done already,
    or `softened` where all is, at fewer samples.
    """
    source, unread = softened_from(setting)
    uniforms, defines = how(setting, source)

    def in_place(inputs: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, int]]:
        return {**uniforms, "open_thickness": open_thickness(inputs["mesh"], setting)}, defines

    def draw(frame: Frame) -> None:
        fed, permutation = in_place(frame.inputs)
        frame.fill("blur.frag", fed, **permutation)

    return Pass(
        "blur",
        draw,
        reads=("mesh", "front", source, "coverage"),
        unread=unread,
        writes={"blurred_thickness": TextureSpec(setting.size, 1)},
        mask="coverage",
        in_place=in_place,
    )


def softened_from(setting: Setting) -> tuple[str, dict[str, str]]:
    """The layer that is read, and why not the others."""
    not_sparse = why_not_sparse(setting)
    if not not_sparse:
        why = f"layers.resolution is {setting.scene.layers.resolution}, so the layer is softened while it is sparse"
        return "softened", {"second": why, "softened_across": why}
    kernel = f'blur.kernel is "{setting.scene.blur.kernel}"'
    if kernel_of(setting).separable:
        return "softened_across", {"second": f"{kernel}, so the rows are softened first", "softened": not_sparse}
    return "second", {"softened_across": kernel, "softened": not_sparse}


def how(setting: Setting, source: str) -> tuple[dict[str, Any], dict[str, int]]:
    """Uniforms and permutation of `glsl/common_blurred_thickness.glsl`."""
    if source == "softened":
        uniforms, defines = upsampling(setting)
        return uniforms, {"SPARSE": 1, **defines}
    published = {"AS_PUBLISHED": int(setting.published)}
    return tap_uniforms(setting), {**published, **tap_defines(setting, source == "softened_across")}
