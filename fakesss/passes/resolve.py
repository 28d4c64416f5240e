"""Samples to pixels, over the background."""

from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.scene import Scene


def resolve(scene: Scene, samples: int) -> Pass:
    """Reads `shaded`, n x n samples a pixel; writes `image` (linear RGB over the background, coverage)."""
    published = int(scene.style == "as published")

    def draw(frame: Frame) -> None:
        frame.fill("resolve.frag", {"background": scene.background}, SAMPLES=samples, AS_PUBLISHED=published)

    return Pass("resolve", draw, reads=("shaded",), writes={"image": TextureSpec(scene.size, 4)})
