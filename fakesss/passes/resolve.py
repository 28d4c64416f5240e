"""Samples to pixels."""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Choice, Pass, TextureSpec


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
