"""`[[control]]`: pictures of the renderer that belong to no factor, among them two that are opaque."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from fakesss.problem import BadInput, Strict
from fakesss.scene import Scene
from stimuli.changes import changed
from stimuli.levels import leaves, written

# Leaves a ka Kd Ia + Kd Id max(N.L, 0) of equation 3.6; whether it casts shadows is for light.shadows to say.
LAMBERTIAN = {
    "material.backlight": 0.0,
    "material.diffuse_contribution": 1.0,
    "material.specular_contribution": 0.0,
}
# a Kd Ia with Ia = 1 from everywhere: as light as a Lambertian that faces its light. Marlow, Kim & Anderson 2017.
GANZFELD = {
    "material.backlight": 0.0,
    "material.diffuse_contribution": 0.0,
    "material.specular_contribution": 0.0,
    "material.ambient": 1.0,
    "lights": (),
    "light.ambient": (1.0, 1.0, 1.0),
    "occlusion.enabled": True,
    "occlusion.method": "baked",
    "occlusion.sampling": "cosine",
}
KINDS: Mapping[str, Mapping[str, Any]] = {"lambertian": LAMBERTIAN, "ganzfeld": GANZFELD}


class Control(Strict):
    """A picture of the renderer that belongs to no factor: the base scene with some fields set otherwise."""

    label: Annotated[str, Field(min_length=1, description="name in tables")]
    kind: Literal["lambertian", "ganzfeld"] | None = Field(
        None, description="lambertian: opaque and matt under the scene's lights; ganzfeld: the same in uniform light"
    )
    set: dict[str, Any] = Field({}, description="scene field = value, as { material.backlight = 0 }; after `kind`")

    @property
    def where(self) -> str:
        """Its place in study.toml."""
        return f"study.toml: control {written(self.label)}"

    def scene(self, base: Scene) -> Scene:
        """`base` with the fields set, or `BadInput` naming control, field and mend."""
        if self.kind is None and not dict(leaves(self.set)):
            raise BadInput(
                f"{self.where}: sets nothing; name a field, for example set = {{ material.backlight = 0 }}, or a kind"
            )
        return changed(base if self.kind is None else base.replace(KINDS[self.kind], self.where), self.set, self.where)
