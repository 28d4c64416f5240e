"""Samples to pixels."""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Choice, Pass, TextureSpec
from fakesss.knob import Knob, culled, levels, spread_order

SAMPLES = levels("supersampling", (1, 2, 3, 4, 6, 8))
KNOBS = (
    Knob(
        name="supersampling",
        levels=SAMPLES,
        reference=SAMPLES[-1],
        error="the share of a pixel that each thing covers: edges, and grain of what is turned from pixel to pixel",
        unused=culled("shade"),
        order=2 * spread_order(2),  # value x value samples in a pixel
        beside=3,  # it multiplies every other cost
    ),
)


def resolve(setting: Setting) -> Pass:
    """Reads `shaded`, n x n samples a pixel; writes `resolved`: linear RGB over the background, coverage."""
    samples, published = setting.samples, int(setting.published)

    def draw(frame: Frame) -> None:
        frame.fill("resolve.frag", {}, SAMPLES=samples, AS_PUBLISHED=published)

    return Pass("resolve", draw, reads=("shaded",), writes={"resolved": TextureSpec(setting.scene.size, 4)})


def image(setting: Setting) -> Choice:
    """The picture: `resolved`, or `shaded` itself where that comes to the same."""
    if setting.samples == 1 and not setting.published:
        one = "one sample a pixel"
        return Choice("image", "shaded", one, {"resolved": one})
    many = f"{setting.samples} x {setting.samples} samples a pixel"
    return Choice("image", "resolved", "as published" if setting.published else many, {})
