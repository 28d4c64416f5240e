"""The textures that depth layers are kept in (`glsl/common_layers.glsl`)."""

from fakesss.calls import Setting, as_published, no_thickness
from fakesss.frame_graph import TextureSpec
from fakesss.knob import Knob, first_of, levels

DEPTHS = levels("layers.depth", ("float16", "float32"))
KNOBS = (
    Knob(
        name="depth format",
        levels=DEPTHS,
        reference=DEPTHS[1],
        error="depths rounded to 1/512 or 1/1024 sphere radii",
        unused=first_of(no_thickness, as_published),
    ),
)


def layer(setting: Setting, size: tuple[int, int] | None = None) -> TextureSpec:
    """A layer of the picture's samples, or of `size`.

    As float16 a depth of 1..3 radii has 11 significant bits: 2^-10 radii apart up to 2, 2^-9 beyond. OpenGL may round
    to either neighbour, so a thickness may be wrong by 2^-9 radii, 1e-3 diameters.
    """
    return TextureSpec(size or setting.size, 1, setting.scene.layers.depth)


def is_half(setting: Setting) -> int:
    """1 where layers are float16: the shaders' define `HALF`."""
    return int(setting.scene.layers.depth == "float16")
