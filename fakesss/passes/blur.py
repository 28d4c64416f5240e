"""Thickness to a softened second layer, so that its edges do not show through as hard lines."""

from collections.abc import Mapping
from typing import Any

from fakesss.calls import Setting, no_thickness
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.knob import Knob, Level, culled, first_of
from fakesss.passes.thickness import open_thickness

SOFTENED = Level("5x5", {"blur.enabled": True})
KNOBS = (
    Knob(
        name="blur kernel",
        levels=(Level("none", {"blur.enabled": False}), SOFTENED),
        reference=SOFTENED,
        error="how soft the second layer's edges are",
        unused=first_of(no_thickness, culled("blur")),
    ),
)

PUBLISHED_STEP = 1 / 256  # of the viewport, thesis appendix C.2.1
PUBLISHED_RANGE = 0.10  # of non-linear depth, thesis eq. C.1


def blur(setting: Setting) -> Pass:
    """Reads `mesh`, `front` and `second`; writes `blurred_thickness` (0..1). The shading can compute it in place."""
    published, view, settings = setting.published, setting.view, setting.scene.blur
    constants = {
        "tap": (PUBLISHED_STEP, PUBLISHED_STEP) if published else view.in_picture(2 * settings.step),
        "depth_range": PUBLISHED_RANGE if published else 2 * settings.depth_range,
        **({"clip": (view.near, view.far), "distance": view.distance} if published else {}),
    }

    def in_place(inputs: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, int]]:
        uniforms = {**constants, "open_thickness": open_thickness(inputs["mesh"], setting)}
        return uniforms, {"AS_PUBLISHED": int(published)}

    def draw(frame: Frame) -> None:
        uniforms, defines = in_place(frame.inputs)
        frame.fill("blur.frag", uniforms, **defines)

    return Pass(
        "blur",
        draw,
        reads=("mesh", "front", "second", "coverage"),
        writes={"blurred_thickness": TextureSpec(setting.size, 1)},
        mask="coverage",
        in_place=in_place,
    )
