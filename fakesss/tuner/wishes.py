"""What a viewer asks to see: a scene, as what differs from the one that the tuner was started with."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from fakesss.problem import Strict
from fakesss.scene import Scene

EffectName = Literal["backlight", "blur", "occlusion", "diffuse", "specular", "shadows"]
Switch = Literal["on", "off"]

OFF: Mapping[str, Mapping[str, Any]] = {
    "backlight": {"material.backlight": 0.0},
    "blur": {"blur.enabled": False},
    "occlusion": {"occlusion.enabled": False},
    "diffuse": {"material.diffuse_contribution": 0.0},
    "specular": {"material.specular_contribution": 0.0},
    "shadows": {},  # of each light: see `switched`
}
"""The scene fields that leave an effect out: part of the scene, so that what is saved looks the same."""

ON: Mapping[str, Mapping[str, Any]] = {"blur": {"blur.enabled": True}, "occlusion": {"occlusion.enabled": True}}
"""Those that allow it. Whether it is then simulated is decided by what it weighs, unless it is forced."""


class Settings(Strict):
    """What differs from the scene that the tuner was started with."""

    changes: dict[str, Any] = Field(default_factory=dict, description="scene path -> value; `lights` as a whole list")
    effects: dict[EffectName, Switch] = Field(default_factory=dict, description="switched by hand; others: auto")

    def scene(self, base: Scene) -> Scene:
        """The scene, checked: `BadInput` names the path that is wrong."""
        scene = base.replace(self.changes, "tuner") if self.changes else base
        overrides = dict(switched(scene, self.effects))
        return scene.replace(overrides, "tuner") if overrides else scene

    @property
    def forced(self) -> frozenset[str]:
        """Effects to simulate although their weight is zero: that costs time, and changes no byte of the picture."""
        return frozenset(name for name, switch in self.effects.items() if switch == "on")


def switched(scene: Scene, effects: Mapping[EffectName, Switch]) -> Iterator[tuple[str, Any]]:
    """The scene fields that effects switched by hand set."""
    for name, switch in effects.items():
        if name == "shadows":
            places = ["light", *(f"lights.{number}" for number in range(len(scene.lights)))]
            yield from ((f"{place}.shadows", switch == "on") for place in places)
        else:
            yield from (OFF if switch == "off" else ON).get(name, {}).items()


class Wish(Strict):
    """One picture that a viewer wants to see next."""

    number: Annotated[int, Field(ge=0)]
    settings: Settings = Settings()
    view: str = Field("picture", description="an intermediate's name (docs/views.md), or the picture")
    moving: bool = Field(False, description="true: soon to be replaced, so as fast as possible; false: as it will be")
