"""Image cues of a stimulus: what a picture offers the eye, whatever its scene says. docs/cues.md tells of each.

All are of linear light as the display shows it (clipped to 0..1, before 8-bit code values), over the object alone: a
pixel counts by its coverage, and the background that shines through its uncovered part is taken out first. Pixels
(N,) come with `weight`, their coverage 0..1, of the same shape; colours are (3, N), a channel after the other.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.colour import decode_srgb, luminance

Float64 = NDArray[np.float64]
FLAT = 1e-5  # relative spread that is rounding: no display shows it, and float32 leaves 5e-7 at the object's edge
HIGHLIGHT = 0.5  # of the display's white, in every channel
DARKEST = float(decode_srgb(np.array([1 / 255]))[0])  # linear light of the display's first code value, .0003
DIGITS, DECIMALS = 6, 9  # kept: sums differ beyond them from processor to processor
NOTHING_COVERED = "no pixel shows the object"
OTHER_ORIGIN = "the picture is of other origin, so its thickness is not known"


class NoCue(ValueError):
    """The picture has no such cue; the message says why."""


@dataclass(frozen=True)
class Cues:
    """Value of each cue, None where there is none; `missing` then says why."""

    values: dict[str, float | None]
    missing: dict[str, str]

    def facts(self) -> dict[str, Any]:
        """As they stand in a manifest entry."""
        return {"cues": self.values, "cues_missing": self.missing}


def mean(values: Float64, weight: Float64) -> float:
    """sum w x / sum w. Raises `NoCue` where nothing is covered."""
    total = float(weight.sum())
    if total == 0:
        raise NoCue(NOTHING_COVERED)
    return float((weight * values).sum()) / total  # no np.dot: its threads would take the time of drawing


def central(values: Float64, weight: Float64) -> tuple[float, Float64]:
    """The mean, and the deviations from it: all 0 where their spread is rounding."""
    middle = mean(values, weight)
    deviation = values - middle
    spread = np.sqrt(mean(deviation**2, weight))
    return middle, deviation if spread > FLAT * abs(middle) else np.zeros_like(deviation)


def lowest(rgb: Float64) -> Float64:
    """The lowest channel: numpy's own minimum is slow along an axis of three."""
    return np.asarray(np.minimum(np.minimum(rgb[0], rgb[1]), rgb[2]))


def mean_luminance(light: Float64, weight: Float64) -> float:
    """Mean relative luminance, 0 black to 1 the display's white: how light the object is, no sign of translucency.

    Nagai et al. (2013) found that translucency goes by luminance in some regions, not over the whole object.
    """
    return mean(light, weight)


def rms_contrast(light: Float64, weight: Float64) -> float:
    """sqrt(mean((L - m)^2)) / m, m the mean luminance: Moulden, Kingdom & Gatley 1990, relative to the mean.

    Michelson's contrast is of two pixels only, the brightest and the darkest; Peli (1990) on why that does not do.
    Over a whole picture it did not go along with translucency in Nagai et al. (2013).
    """
    middle, deviation = central(light, weight)
    if middle == 0:
        raise NoCue("the object is black, and contrast is relative to its mean luminance")
    return float(np.sqrt(mean(deviation**2, weight))) / middle


def luminance_skew(light: Float64, weight: Float64) -> float:
    """mean((L - m)^3) / mean((L - m)^2)^(3/2): Motoyoshi, Nishida, Sharan & Adelson 2007."""
    _, deviation = central(light, weight)
    variance = mean(deviation**2, weight)
    if variance == 0:
        raise NoCue("the object has one luminance, which has no skew")
    return float(mean(deviation * deviation**2, weight) / variance**1.5)


def saturation_intensity_correlation(rgb: Float64, weight: Float64) -> float:
    """Pearson's correlation, over the object, of saturation and intensity: Fleming & Buelthoff 2005.

    rgb (3, N). Intensity I = (R + G + B) / 3, saturation S = 1 - min(R, G, B) / I; pixels that are black on the
    display, every channel below `DARKEST`, have no saturation and do not count. Above 0 the object glows warm where it
    is bright, below 0 it looks icy.
    """
    channels = rgb[0] + rgb[1] + rgb[2]
    weight = np.where(np.maximum(np.maximum(rgb[0], rgb[1]), rgb[2]) >= DARKEST, weight, 0.0)
    if weight.size and not weight.any():
        raise NoCue("the object is black, which has no saturation")
    saturation = 1 - 3 * np.divide(lowest(rgb), channels, out=np.zeros_like(channels), where=channels > 0)
    if np.sqrt(mean(saturation**2, weight)) <= FLAT:
        raise NoCue("the object is grey, so no saturation goes along with intensity")
    (_, s), (_, i) = central(saturation, weight), central(channels / 3, weight)
    for deviation, what in ((s, "saturation"), (i, "intensity")):
        if not deviation.any():
            raise NoCue(f"the object has one {what}, so nothing goes along with it")
    return mean(s * i, weight) / float(np.sqrt(mean(s**2, weight) * mean(i**2, weight)))


def gradient_energy(light: Float64, weight: Float64, inside: NDArray[np.bool_]) -> float:
    """(mean(Lx^2) + mean(Ly^2)) / mean((L - m)^2) of the pixels that are `inside` (H, W): the less, the more blurred.

    Energy of image gradient (Subbarao, Choi & Nikzad 1993): Lx and Ly are differences of neighbouring pixels, a pair
    counting by the lesser coverage, so that the outline is no edge. The variance takes contrast out. It is per pixel:
    compare pictures of one size.
    """
    _, deviation = central(light, weight)
    variance = mean(deviation**2, weight)
    if variance == 0:
        raise NoCue("the object has one luminance, which is neither sharp nor blurred")
    levels, coverage = np.zeros(inside.shape), np.zeros(inside.shape)
    levels[inside], coverage[inside] = deviation, weight
    return sum(mean_square_step(*way) for way in ((levels, coverage), (levels.T, coverage.T))) / variance


def mean_square_step(light: Float64, weight: Float64) -> float:
    """Mean squared difference of (H, W) pixels and those below them; 0 where the object has no such pair."""
    pair = np.minimum(weight[1:], weight[:-1])
    return mean((light[1:] - light[:-1]) ** 2, pair) if pair.any() else 0.0


def is_highlight(rgb: Float64) -> NDArray[np.bool_]:
    """Where all three channels exceed `HIGHLIGHT`: as bright and as white as a highlight of a white light.

    A highlight has the light's colour, what is scattered has the object's (Shafer 1985). rgb (3, N).
    """
    return np.asarray(lowest(rgb) > HIGHLIGHT)


def highlight_share(rgb: Float64, weight: Float64) -> float:
    """Share of the object's area that is highlight, 0..1: the coverage of Marlow, Kim & Anderson 2012.

    Found in the picture, not in the specular term: a glow that is white counts too, a dim highlight does not.
    """
    return mean(is_highlight(rgb).astype(np.float64), weight)


def contrast_beside_highlights(rgb: Float64, light: Float64, weight: Float64) -> float:
    """RMS contrast of what is no highlight, the nearest a picture has to the non-specular part: Motoyoshi 2010."""
    rest = np.where(is_highlight(rgb), 0.0, weight)
    if weight.any() and not rest.any():
        raise NoCue("all of the object is highlight")
    return rms_contrast(light, rest)


def mean_thickness(thickness: NDArray[Any], coverage: NDArray[Any]) -> float | None:
    """Mean, in sphere diameters, over the samples that show the object; None where none does.

    `thickness` (n H, n W) has n x n samples a pixel, 0 where they miss the object; `coverage` (H, W) is their share
    that does not. Thickness is what tells a glow from a highlight: Gascons 2011, eq. 3.6.
    """
    samples = float(coverage.sum(dtype=np.float64)) * thickness.size / coverage.size
    return float(thickness.sum(dtype=np.float64)) / samples if samples else None


def cues_of_rendering(image: NDArray[Any], background: tuple[float, float, float], thickness: float | None) -> Cues:
    """Cues of linear RGB over `background` and coverage (H, W, 4); `thickness`: see `mean_thickness`."""
    inside = np.ascontiguousarray(image[..., 3]) > 0
    *channels, coverage = np.ascontiguousarray(image[inside].T, np.float64)
    behind = 1 - coverage
    colour = [(channel - behind * light) / coverage for channel, light in zip(channels, background, strict=True)]
    return cues_of(np.clip(colour, 0.0, 1.0), coverage, inside[around(inside)], thickness, NOTHING_COVERED)


def cues_of_picture(pixels: NDArray[np.uint8]) -> Cues:
    """Cues of a picture of other origin, 8-bit sRGB (H, W, 3): of all of it, since no file says where its object is."""
    linear = decode_srgb(np.arange(256) / 255)[pixels.reshape(-1, 3).T]
    everywhere = np.ones(pixels.shape[:2], bool)
    return cues_of(linear, np.ones(everywhere.size), everywhere, None, OTHER_ORIGIN)


def cues_of(
    rgb: Float64, weight: Float64, inside: NDArray[np.bool_], thickness: float | None, no_thickness: str
) -> Cues:
    """Every cue of linear RGB (3, N), 0..1, of the N pixels of a picture that are `inside` (H, W)."""
    light = luminance(rgb.T)
    makers: dict[str, Callable[[], float]] = {
        "mean_luminance": lambda: mean_luminance(light, weight),
        "rms_contrast": lambda: rms_contrast(light, weight),
        "contrast_beside_highlights": lambda: contrast_beside_highlights(rgb, light, weight),
        "luminance_skew": lambda: luminance_skew(light, weight),
        "saturation_intensity_correlation": lambda: saturation_intensity_correlation(rgb, weight),
        "gradient_energy": lambda: gradient_energy(light, weight, inside),
        "highlight_share": lambda: highlight_share(rgb, weight),
    }
    values: dict[str, float | None] = {}
    missing: dict[str, str] = {}
    for name, make in makers.items():
        try:
            values[name] = rounded(make())
        except NoCue as reason:
            values[name], missing[name] = None, str(reason)
    values["mean_thickness"] = None if thickness is None else rounded(thickness)
    if thickness is None:
        missing["mean_thickness"] = no_thickness
    return Cues(values, missing)


def rounded(value: float) -> float:
    """Six significant digits, nine decimals at most, no negative zero."""
    return float(f"{round(value, DECIMALS):.{DIGITS}g}") + 0.0


def around(inside: NDArray[np.bool_]) -> tuple[slice, slice]:
    """Rows and columns of the smallest box (H, W) that has all of it."""
    places = [np.flatnonzero(inside.any(axis=axis)) for axis in (1, 0)]
    rows, columns = (slice(found[0], found[-1] + 1) if len(found) else slice(0) for found in places)
    return rows, columns
