"""Thickness without hard edges inside the object: matter behind a gap counts the less, the wider the gap.

The first interval jumps where the surface behind it folds: a gap closes, and two parts become one. Here

    t = sum over intervals i of c_i exp(-G_i / g),

c_i the length of interval i, G_i the width of all gaps before it, g `layers.gap`. As a gap closes, exp(-G / g) rises
to 1, and as an interval vanishes its neighbours' gaps multiply to the weight of one gap: t changes continuously with
the ray in both cases. A thin part far in front of a thick one still glows, since what lies many g behind counts
nothing. g -> 0 is the first interval, g -> infinity the total path. Only the first three intervals are counted.
"""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.passes.peel import DEEPEST

LAYERS = ("front", "first_exit", *(f"layer_{number}" for number in range(3, DEEPEST + 1)))


def bridge(setting: Setting) -> Pass:
    """Reads the first six layers; writes `bridged_exit`: the depth at which so long a first interval would end."""
    gap = 2 * setting.scene.layers.gap  # sphere radii

    def draw(frame: Frame) -> None:
        frame.fill("bridge.frag", {"gap": gap})

    return Pass(
        "bridge",
        draw,
        reads=(*LAYERS, "coverage"),
        writes={"bridged_exit": TextureSpec(setting.size, 1)},
        mask="coverage",
    )
