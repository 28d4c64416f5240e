"""What a scene calls for. An effect that is switched off, or whose weight is zero, is not simulated."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from fakesss.camera import View
from fakesss.lights import Light
from fakesss.scene import Scene

Reason = Callable[[Scene], str]  # the setting that says no, in words; "" if none does


def never(scene: Scene) -> str:
    return ""


@dataclass(frozen=True)
class Effect:
    """Why a scene does without an effect.

    `off` changes the picture; `weightless` does not: the effect, forced on, would be multiplied by zero.
    """

    weightless: Reason
    off: Reason = never

    def why_not(self, scene: Scene) -> str:
        """The first reason against the effect, or "" if the scene calls for it."""
        return self.off(scene) or self.weightless(scene)


def lights_of(scene: Scene) -> tuple[Light, ...]:
    """The main light and the further ones."""
    return (scene.light, *scene.lights)


def none_shines(scene: Scene, term: str) -> str:
    """`light.ambient is 0`, if it is for every light."""
    if any(any(getattr(light, term)) for light in lights_of(scene)):
        return ""
    return f"light.{term} is 0" + (" in every light" if scene.lights else "")


def when(holds: bool, sentence: str) -> str:
    """`sentence` if the condition holds, otherwise no reason."""
    return sentence if holds else ""


def no_backlight(scene: Scene) -> str:
    return when(scene.material.backlight == 0, "material.backlight is 0")


def no_ambient(scene: Scene) -> str:
    return when(scene.material.ambient == 0, "material.ambient is 0") or none_shines(scene, "ambient")


def no_diffuse(scene: Scene) -> str:
    zero = scene.material.diffuse_contribution == 0
    return when(zero, "material.diffuse_contribution is 0") or none_shines(scene, "diffuse")


def no_specular(scene: Scene) -> str:
    material = scene.material
    return (
        when(material.specular == 0, "material.specular is 0")
        or when(material.specular_contribution == 0, "material.specular_contribution is 0")
        or none_shines(scene, "specular")
    )


def shining(scene: Scene) -> tuple[Light, ...]:
    """The lights that add a diffuse or specular term."""
    terms = [term for term, reason in (("diffuse", no_diffuse), ("specular", no_specular)) if not reason(scene)]
    return tuple(light for light in lights_of(scene) if any(any(getattr(light, term)) for term in terms))


def no_shadow(scene: Scene) -> str:
    """Nothing that a shadow could dim."""
    diffuse, specular = no_diffuse(scene), no_specular(scene)
    if diffuse and specular:
        return f"{diffuse} and {specular}"
    dark = any(light.shadows for light in lights_of(scene)) and not any(light.shadows for light in shining(scene))
    return when(dark, "no light with shadows = true shines")


def no_caster(scene: Scene) -> str:
    return when(not any(light.shadows for light in lights_of(scene)), "no light has shadows = true")


def occlusion_off(scene: Scene) -> str:
    return when(not scene.occlusion.enabled, "occlusion.enabled is false")


def blur_off(scene: Scene) -> str:
    return when(not scene.blur.enabled, "blur.enabled is false")


EFFECTS: Mapping[str, Effect] = {
    "backlight": Effect(weightless=no_backlight),
    "blur": Effect(weightless=no_backlight, off=blur_off),
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

    @property
    def shining(self) -> tuple[Light, ...]:
        """The lights whose diffuse and specular terms are computed: those that shine, unless these are forced."""
        in_vain = self.forced & {"diffuse", "specular", "shadows"}
        return lights_of(self.scene) if in_vain else shining(self.scene)

    @property
    def casting(self) -> tuple[Light, ...]:
        """The lights with a shadow map."""
        return () if self.lacking("shadows") else tuple(light for light in self.shining if light.shadows)
