"""Ambient occlusion from the front layer, without rays.

What it is *not*: the bake's. It knows only what the camera sees and takes that for as deep as the radius, so parts
that are hidden or outside the picture block nothing, and it changes as the camera turns.
"""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.knob import Knob, culled, levels, spread_order
from fakesss.screen_occlusion import POINTS

SAMPLES = levels("occlusion.samples", (16, 32, 64, 128, 256))
KNOBS = (
    Knob(
        name="screen-space samples",
        levels=SAMPLES,
        reference=SAMPLES[-1],
        error="the share of directions that the front layer blocks; what the camera does not see is no part of it",
        unused=culled("sample_occlusion"),
        order=spread_order(3),  # directions and distances
        beside=64,
    ),
)


def sample_occlusion(setting: Setting) -> Pass:
    """Reads `front` and `surface`; writes `sampled_occlusion`: the share of directions in which no point is hidden,
    turned by a tile of 4 x 4 rotations."""
    settings, view = setting.scene.occlusion, setting.view
    uniforms = {
        "tangent": view.tangent,
        "camera_distance": view.distance,
        "radius": 2 * settings.radius,
        "bias": 2 * settings.bias,
    }
    defines = {"DIRECTIONS": settings.samples // POINTS, "UNIFORM_OVER_HEMISPHERE": int(settings.sampling == "uniform")}
    return Pass(
        "sample_occlusion",
        lambda frame: frame.fill("sample_occlusion.frag", uniforms, **defines),
        reads=("front", "surface", "coverage"),
        writes={"sampled_occlusion": TextureSpec(setting.size, 1)},
        mask="coverage",
    )


def screen_occlusion(setting: Setting) -> Pass:
    """Reads `front` and `sampled_occlusion`; writes `screen_occlusion` (0..1): the mean over the tile of rotations."""
    depth_range = 2 * setting.scene.occlusion.radius

    def draw(frame: Frame) -> None:
        frame.fill("screen_occlusion.frag", {"depth_range": depth_range})

    return Pass(
        "screen_occlusion",
        draw,
        reads=("front", "sampled_occlusion", "coverage"),
        writes={"screen_occlusion": TextureSpec(setting.size, 1)},
        mask="coverage",
    )
