"""What a scene calls for. An effect that is switched off, or whose weight is zero, is not simulated."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View
from fakesss.lights import Light
from fakesss.scene import Material, Scene

Array = NDArray[np.float64]
Reason = Callable[[Scene], str]  # the setting that says no, in words; "" if none does


def never(scene: Scene) -> str:
    return ""


@dataclass(frozen=True)
class Effect:
    """Why a scene does without an effect.

    `off` changes the picture; `weightless` does not: the effect, forced on, would be multiplied by zero, or its
    thickness raised to the power of zero.
    """

    weightless: Reason
    off: Reason = never

    def why_not(self, scene: Scene) -> str:
        """The first reason against the effect, or "" if the scene calls for it."""
        return self.off(scene) or self.weightless(scene)


def lights_of(scene: Scene) -> tuple[Light, ...]:
    """The main light and the further ones."""
    return (scene.light, *scene.lights)


def ambient_colour(scene: Scene) -> Array:
    """ka Kd Ia of eq. 3.7, the lights' ambient intensities added up."""
    material = scene.material
    intensity = np.sum([light.ambient for light in lights_of(scene)], axis=0)
    return np.asarray(material.ambient * np.array(material.diffuse) * intensity)


def diffuse_colour(material: Material, light: Light) -> Array:
    """wd Kd Id of eq. 3.8."""
    return np.asarray(material.diffuse_contribution * np.array(material.diffuse) * light.diffuse)


def specular_colour(material: Material, light: Light) -> Array:
    """ws ks Is of eq. 3.9."""
    return np.asarray(material.specular_contribution * material.specular * np.array(light.specular))


def backlight_colour(scene: Scene) -> Array:
    """wb (Kd + Kb) of eq. 3.10."""
    material = scene.material
    return np.asarray(material.backlight * (np.array(material.diffuse) + material.diffuse_weight))


def reflects(material: Material, intensity: tuple[float, ...]) -> bool:
    """Whether Kd times `intensity` is not black."""
    return any(share and light for share, light in zip(material.diffuse, intensity, strict=True))


def none_shines(scene: Scene, term: str) -> str:
    """`light.ambient is 0`, if it is for every light."""
    if any(any(getattr(light, term)) for light in lights_of(scene)):
        return ""
    return f"light.{term} is 0" + (" in every light" if scene.lights else "")


def none_reflected(scene: Scene, term: str) -> str:
    """The same where each light has only colours that the material swallows."""
    some = any(reflects(scene.material, getattr(light, term)) for light in lights_of(scene))
    return when(not some, f"material.diffuse reflects none of the {term} light")


def when(holds: bool, sentence: str) -> str:
    """`sentence` if the condition holds, otherwise no reason."""
    return sentence if holds else ""


def as_published(scene: Scene) -> str:
    return when(scene.style == "as published", 'style is "as published"')


def no_exposure(scene: Scene) -> str:
    return when(scene.exposure == 0, "exposure is 0")


def no_backlight(scene: Scene) -> str:
    """Why `backlight_colour` is black, or nothing of it is shown."""
    return (
        no_exposure(scene)
        or when(scene.material.backlight == 0, "material.backlight is 0")
        or when(
            not any(share + scene.material.diffuse_weight for share in scene.material.diffuse),
            "material.diffuse plus diffuse_weight is 0",
        )
    )


def no_thickness(scene: Scene) -> str:
    """A power of 0 is 1 at any thickness."""
    constant = scene.material.thickness_exponent == 0
    return no_backlight(scene) or when(constant, "material.thickness_exponent is 0, so thickness does not matter")


def no_ambient(scene: Scene) -> str:
    """Why `ambient_colour` is black, or nothing of it is shown."""
    return (
        no_exposure(scene)
        or when(scene.material.ambient == 0, "material.ambient is 0")
        or none_shines(scene, "ambient")
        or none_reflected(scene, "ambient")
    )


def no_diffuse(scene: Scene) -> str:
    """Why `diffuse_colour` is black for every light, or nothing of it is shown."""
    zero = scene.material.diffuse_contribution == 0
    return (
        no_exposure(scene)
        or when(zero, "material.diffuse_contribution is 0")
        or none_shines(scene, "diffuse")
        or none_reflected(scene, "diffuse")
    )


def no_specular(scene: Scene) -> str:
    """Why `specular_colour` is black for every light, or nothing of it is shown."""
    material = scene.material
    return (
        no_exposure(scene)
        or when(material.specular == 0, "material.specular is 0")
        or when(material.specular_contribution == 0, "material.specular_contribution is 0")
        or none_shines(scene, "specular")
    )


def shining(scene: Scene) -> tuple[Light, ...]:
    """The lights that add a diffuse or specular term."""
    if no_exposure(scene):
        return ()
    material = scene.material
    highlight = material.specular and material.specular_contribution
    return tuple(
        light
        for light in lights_of(scene)
        if (material.diffuse_contribution and reflects(material, light.diffuse)) or (highlight and any(light.specular))
    )


def no_shadow(scene: Scene) -> str:
    """Nothing that a shadow could dim."""
    diffuse, specular = no_diffuse(scene), no_specular(scene)
    if diffuse and specular:
        return " and ".join(dict.fromkeys((diffuse, specular)))
    dark = any(light.shadows for light in lights_of(scene)) and not any(light.shadows for light in shining(scene))
    return when(dark, "no light with shadows = true shines")


def no_caster(scene: Scene) -> str:
    return when(not any(light.shadows for light in lights_of(scene)), "no light has shadows = true")


def occlusion_off(scene: Scene) -> str:
    return when(not scene.occlusion.enabled, "occlusion.enabled is false")


def blur_off(scene: Scene) -> str:
    return when(not scene.blur.enabled, "blur.enabled is false")


EFFECTS: Mapping[str, Effect] = {
    "backlight": Effect(weightless=no_thickness),
    "blur": Effect(weightless=no_thickness, off=blur_off),
    "occlusion": Effect(weightless=no_ambient, off=occlusion_off),
    "diffuse": Effect(weightless=no_diffuse),
    "specular": Effect(weightless=no_specular),
    "shadows": Effect(weightless=no_shadow, off=no_caster),
}


@dataclass(frozen=True)
class Setting:
    """What every pass of one picture is told."""

    scene: Scene
    view: View
    size: tuple[int, int]  # samples: the picture's width and height times the samples a side
    samples: int  # n of the n x n samples in a pixel
    solid: bool  # the mesh is closed and does not pass through itself (`fakesss.solidity`)
    forced: frozenset[str] = frozenset()  # effects to simulate although they weigh nothing, to show that it is in vain

    @property
    def published(self) -> bool:
        """Whether the flaws of the program of 2011 are asked for."""
        return self.scene.style == "as published"

    @property
    def outside_only(self) -> bool:
        """Whether the camera sees nothing of the object's inside: front faces hide all back faces."""
        return self.solid and not self.view.clips_sphere

    def lacking(self, effect: str) -> str:
        """Why `effect` is not simulated, or "" if it is."""
        known = EFFECTS[effect]
        return known.off(self.scene) or ("" if effect in self.forced else known.weightless(self.scene))

    @cached_property
    def shining(self) -> tuple[Light, ...]:
        """The lights whose diffuse and specular terms are computed: those that shine, unless these are forced."""
        in_vain = self.forced & {"diffuse", "specular", "shadows"}
        return lights_of(self.scene) if in_vain else shining(self.scene)

    @cached_property
    def casting(self) -> tuple[Light, ...]:
        """The lights with a shadow map."""
        return () if self.lacking("shadows") else tuple(light for light in self.shining if light.shadows)
