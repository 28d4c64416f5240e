"""Thickness without hard edges inside the object: matter behind a gap counts the less, the wider the gap.

The first stretch inside jumps where the surface behind it folds: a gap closes, and two parts become one. Here

    t = sum over stretches i of c_i exp(-G_i / g),

c_i the length of stretch i, G_i the width of all gaps before it, g `layers.gap`. As a gap closes, exp(-G / g) rises
to 1, and as a stretch vanishes its neighbours' gaps multiply to the weight of one gap: t changes continuously with
the ray in both cases. A thin part far in front of a thick one still glows, since what lies many g behind counts
nothing. g -> 0 is the first stretch, g -> infinity the total path. Only the first six surfaces are counted.

Inside is where the ray has met more front faces than back faces. Where parts pass through one another, a stretch is
thus their union, while the first interval ends at whatever surface comes next.
"""

from fakesss.calls import Setting
from fakesss.frame import Frame
from fakesss.frame_graph import Pass
from fakesss.passes.layer import layer
from fakesss.passes.peel import DEEPEST

EXACT = "sums what the layers hold; that six of them count is part of what this thickness means"

LAYERS = ("front", *(f"layer_{number}" for number in range(2, DEEPEST + 1)))


def bridge(setting: Setting) -> Pass:
    """Reads the first six layers; writes `bridged_exit`: the depth at which so long a first stretch would end."""
    gap = 2 * setting.scene.layers.gap  # sphere radii

    def draw(frame: Frame) -> None:
        frame.fill("bridge.frag", {"gap": gap})

    return Pass(
        "bridge",
        draw,
        reads=(*LAYERS, "coverage"),
        writes={"bridged_exit": layer(setting)},
        mask="coverage",
    )
