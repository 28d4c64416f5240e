"""How a picture is path-traced, checked on reading; imports neither Mitsuba nor OpenGL."""

from typing import Annotated

from pydantic import Field, field_validator

from fakesss.media import medium_named
from fakesss.problem import BadInput, Strict

OPAQUE = "opaque"  # in place of a medium: a Lambertian surface of the scene's diffuse reflectance
ROUND = 4  # samples a pixel that are traced at once, and compared with one another to know the noise
SURE_ROUNDS = 4  # before these a picture's noise is itself too noisy to stop at


class PathTracing(Strict):
    """How a picture is path-traced."""

    medium: str = Field(description='a measured medium (docs/accuracy.md), or "opaque": Lambertian, material.diffuse')
    size_mm: Annotated[float, Field(gt=0, le=1e5)] = Field(30.0, description="diameter of the bounding sphere, mm")
    samples: Annotated[int, Field(ge=2 * ROUND, le=1 << 20, multiple_of=ROUND)] = Field(
        256, description="at most, per pixel"
    )
    noise: Annotated[float, Field(gt=0)] | None = Field(
        None, description="stops once RMS standard error over RMS radiance is at or below it; empty: all samples"
    )
    seed: Annotated[int, Field(ge=0, lt=1 << 32)] = Field(0, description="of the random numbers")
    highlights: bool = Field(True, description="adds the shader's own specular term")
    denoise: bool = Field(False, description="true: a neural network smooths the grain, and the picture is marked")

    @field_validator("medium")
    @classmethod
    def known_medium(cls, name: str) -> str:
        if name.lower() == OPAQUE:
            return OPAQUE
        try:
            return medium_named(name, "medium").name
        except BadInput as error:
            raise ValueError(str(error).removeprefix("medium: ")) from None

    def rounds(self, noises: list[float]) -> int:
        """How many rounds the picture has in the end, as far as their noises so far tell."""
        most = self.samples // ROUND
        if self.noise is not None:
            low = (number for number, value in enumerate(noises, 1) if value <= self.noise)
            most = min(most, next((number for number in low if number >= SURE_ROUNDS), most))
        return most
