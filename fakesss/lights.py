"""Lights and their shadows: what a scene says of them, checked on reading.

Intensities are linear RGB. Lengths are in sphere radii, the object's bounding sphere being the unit.
"""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fakesss.problem import Strict

LARGEST = 1e6  # of any weight or intensity: products of four stay far within float32
NonNegative = Annotated[float, Field(ge=0, le=LARGEST)]
Intensity = tuple[NonNegative, NonNegative, NonNegative]
Attenuation = tuple[NonNegative, NonNegative, NonNegative]
MOST_LIGHTS = 32  # of a scene: with shadows 1400 numbers of the 4096 that drivers let a shader be told


class Light(Strict):
    """A movable light. It adds ambient, diffuse and specular terms; the backlight is always behind the object."""

    kind: Literal["directional", "point", "spot"] = Field(
        "directional", description="directional: infinitely far; point: all around; spot: a cone to the sphere's centre"
    )
    azimuth: float = Field(-35.0, description="degrees around +y from +z (towards the viewer) to +x (right)")
    elevation: Annotated[float, Field(ge=-90, le=90)] = Field(50.0, description="degrees above the horizon")
    distance: Annotated[float, Field(ge=0, le=1e4)] = Field(
        4.0, description="of a point or spot light from the sphere's centre, in sphere radii"
    )
    ambient: Intensity = Field((0.09, 0.09, 0.095), description="ambient intensity [Ia], linear RGB")
    diffuse: Intensity = Field((1.0, 1.0, 1.0), description="diffuse intensity [Id], linear RGB")
    specular: Intensity = Field((1.0, 1.0, 1.0), description="specular intensity [Is], linear RGB")
    attenuation: Attenuation = Field(
        (1.0, 0.0, 0.0), description="[kc, kl, kq] of a point or spot light: 1 / (kc + kl d + kq d^2), d in radii"
    )
    cutoff: Annotated[float, Field(ge=0.1, le=90)] = Field(20.0, description="half angle of a spot's cone, degrees")
    falloff: Literal["exponent", "linear"] = Field(
        "exponent",
        description="from a spot's axis; exponent: cos^e; linear: (c - cf) / (1 - cf), cf the cut-off's cosine",
    )
    spot_exponent: Annotated[float, Field(ge=0, le=1e4)] = Field(1.0, description="e of a spot's exponent fall-off")
    shadows: bool = Field(False, description="true: the object hides this light from itself (shadow map)")

    @model_validator(mode="after")
    def attenuates_finitely(self) -> Self:
        if not any(self.attenuation):
            raise ValueError("attenuation (0, 0, 0) divides by zero; give at least one of kc, kl, kq")
        return self


class Shadow(Strict):
    """How the shadow maps of all lights with `shadows` are made and read."""

    map_size: Annotated[int, Field(ge=16, le=16384)] | None = Field(
        None, description="side of a shadow map in texels; empty: four times the picture's longer side, at most 4096"
    )
    filter: Literal["hard", "pcf", "disc"] = Field(
        "pcf", description="hard: one comparison; pcf: 4 x 4 of them; disc: samples in a disc turned for each pixel"
    )
    samples: Annotated[int, Field(ge=1, le=64)] = Field(8, description="comparisons of the disc filter")
    radius: Annotated[float, Field(gt=0, le=0.5)] = Field(
        0.01, description="of the disc filter's penumbra, in sphere diameters"
    )
    bias: Annotated[float, Field(ge=0, le=0.1)] = Field(
        3e-3, description="depth by which a surface may lie behind the map and still be lit, in sphere diameters"
    )
