"""How a picture is path-traced, checked on reading; imports neither Mitsuba nor OpenGL."""

import math
from collections.abc import Sequence
from typing import Annotated, Any

from pydantic import AfterValidator, Field, field_validator, model_validator

from fakesss.media import medium_named
from fakesss.problem import BadInput, Strict

OPAQUE = "opaque"  # in place of a medium: a Lambertian surface of the scene's diffuse reflectance
ROUND = 4  # samples a pixel that are traced at once, and compared with one another to know the noise
SURE_ROUNDS = 4  # before these a picture's noise is itself too noisy to stop at
MOST = 1 << 20  # samples a pixel
PATIENCE = 4096  # samples a pixel at most, where a noise is asked for and no number of samples
NEAR = 1.01  # noise that is no more than that times the target meets it


def whole_rounds(samples: int) -> int:
    """`samples`, if they make two rounds or more."""
    if not 2 * ROUND <= samples <= MOST or samples % ROUND:
        raise ValueError(f"must be a multiple of {ROUND} from {2 * ROUND} to {MOST}")
    return samples


class PathTracing(Strict):
    """How a picture is path-traced."""

    medium: str = Field(description='a measured medium (docs/accuracy.md), or "opaque": Lambertian, material.diffuse')
    size_mm: Annotated[float, Field(gt=0.1, le=1e5)] = Field(30.0, description="diameter of the bounding sphere, mm")
    samples: Annotated[int, AfterValidator(whole_rounds)] = Field(
        256, description=f"at most, per pixel; empty: 256, {PATIENCE} with a noise"
    )
    noise: Annotated[float, Field(gt=0, lt=1)] | None = Field(
        None, description="stops once RMS standard error over RMS radiance is at or below it; empty: all samples"
    )
    seed: Annotated[int, Field(ge=0, lt=1 << 32)] = Field(0, description="of the random numbers")
    highlights: bool = Field(True, description="adds the shader's own specular term")
    denoise: bool = Field(False, description="true: a neural network smooths the grain, and the picture is marked")

    @model_validator(mode="before")
    @classmethod
    def _patient(cls, given: Any) -> Any:
        if isinstance(given, dict) and given.get("noise") is not None and given.get("samples") is None:
            return {**given, "samples": PATIENCE}
        return given

    @field_validator("medium")
    @classmethod
    def known_medium(cls, name: str) -> str:
        """The medium by its name in the table; `ValueError` names the nearest."""
        if name.lower() == OPAQUE:
            return OPAQUE
        try:
            return medium_named(name, "medium").name
        except BadInput as error:
            raise ValueError(str(error).removeprefix("medium: ")) from None

    def rounds(self, ratios: Sequence[float]) -> int:
        """How many rounds the picture has in the end, as far as their ratios (`noise_of`) so far tell."""
        most = self.samples // ROUND
        low = (number for number, value in enumerate(ratios, 1) if number >= SURE_ROUNDS and self.met(value))
        return most if self.noise is None else min(most, next(low, most))

    def met(self, ratio: float) -> bool:
        """Whether a picture of this ratio is good enough; True where no noise is asked for.

        Up to a target of .14 it is the ratio that counts, which is the noise to 1 %.
        """
        return self.noise is None or (ratio <= self.noise and noise_of(ratio) <= NEAR * self.noise)

    def foreseen(self, rounds: int, ratio: float) -> int:
        """Samples of the whole picture as far as `rounds` tell: noise falls with the root of their number."""
        if self.noise is None or not math.isfinite(ratio):
            return self.samples
        return min(self.samples, ROUND * max(math.ceil(rounds * (ratio / self.noise) ** 2), rounds))


def noise_of(ratio: float) -> float:
    """RMS standard error over RMS radiance, from its ratio to the RMS of the picture, which has the noise in it too.

    The mean square of a picture with grain is that of the radiance and that of the grain. Infinite where nothing else
    is left of it.
    """
    return ratio / math.sqrt(1 - ratio**2) if ratio < 1 else math.inf
