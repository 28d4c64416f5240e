"""Everything a picture depends on, read from TOML; every field has a unit, a range and a default.

World frame: right-handed, y up, the object scaled so that its bounding sphere has radius 1 and is centred at the
origin, its front towards +z. Colours are linear-light RGB with sRGB primaries.
Symbols in brackets are those of equation 3.6 in Gascons, *Fast simulation of translucent objects* (2011).
"""

import hashlib
import json
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, Field, model_validator

from fakesss.lights import LARGEST, MOST_LIGHTS, Light, NonNegative, Shadow
from fakesss.problem import BadInput, Strict, nearest, validated

Unit = Annotated[float, Field(ge=0, le=1)]
Weight = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]
Radii = Annotated[float, Field(gt=0, le=1e4)]
Albedo = tuple[Unit, Unit, Unit]
Pixels = Annotated[int, Field(ge=1, le=16384)]


class Material(Strict):
    """What the object is made of, as far as the empirical model knows."""

    diffuse: Albedo = Field((0.78, 0.24, 0.015), description="diffuse reflectance [Kd], linear RGB, 0..1")
    ambient: NonNegative = Field(1.0, description="ambient reflection coefficient [ka], no unit")
    specular: NonNegative = Field(0.8, description="specular reflection coefficient [ks], no unit")
    shininess: Annotated[float, Field(ge=0, le=1e5)] = Field(100.0, description="Blinn-Phong exponent [n], no unit")
    thickness_exponent: Annotated[float, Field(ge=0, le=1e5)] = Field(
        25.0, description="fall-off of the backlight with thickness [r], no unit"
    )
    backlight: Weight = Field(1.2, description="backlight contribution [wb], no unit")
    thickness: Literal["first-interval", "total-path", "bridged", "local"] = Field(
        "first-interval", description="what the backlight passes through (docs/technique.md)"
    )
    diffuse_weight: Weight = Field(0.2, description="added to every channel of the backlight's colour [Kb]")
    diffuse_contribution: Weight = Field(0.13, description="weight of the diffuse term [wd], no unit")
    specular_contribution: Weight = Field(1.0, description="weight of the specular term [ws], no unit")


class Camera(Strict):
    """A perspective camera that looks at the centre of the bounding sphere."""

    azimuth: float = Field(0.0, description="degrees around +y from +z to +x")
    elevation: Annotated[float, Field(ge=-90, le=90)] = Field(8.0, description="degrees above the horizon")
    field_of_view: Annotated[float, Field(ge=1, le=170)] = Field(
        30.0, description="angle of the shorter side of the picture, degrees"
    )
    distance: Radii | None = Field(
        None, description="from the sphere's centre, in sphere radii; empty: the sphere just fills the shorter side"
    )
    near: Radii | None = Field(
        None, description="near clip distance in sphere radii; empty: fitted to the sphere (eq. 3.4)"
    )
    far: Radii | None = Field(
        None, description="far clip distance in sphere radii; empty: fitted to the sphere (eq. 3.4)"
    )

    @model_validator(mode="after")
    def clip_planes_in_order(self) -> Self:
        if self.near is not None and self.far is not None and self.near >= self.far:
            raise ValueError(f"near {self.near} must be less than far {self.far}")
        return self


class Occlusion(Strict):
    """Ambient occlusion [a]: the share of the normal's hemisphere from which nothing keeps the light."""

    enabled: bool = Field(True, description="false: the whole hemisphere is seen everywhere (a = 1)")
    method: Literal["baked", "screen-space"] = Field(
        "baked", description="baked: rays from every vertex; screen-space: samples of the front layer around each pixel"
    )
    rays: Annotated[int, Field(ge=1, le=65536)] = Field(320, description="rays per vertex, baked")
    sampling: Literal["cosine", "uniform"] = Field(
        "cosine", description="cosine: irradiance-weighted; uniform: plain share of the hemisphere"
    )
    samples: Annotated[int, Field(ge=4, le=256, multiple_of=4)] = Field(
        64, description="points around each sample of the picture, four to a direction, screen-space"
    )
    radius: Annotated[float, Field(gt=0, le=1)] = Field(
        0.4, description="of the hemisphere that is sampled, in sphere diameters, screen-space"
    )
    bias: Annotated[float, Field(ge=0, le=0.1)] = Field(
        2e-3, description="depth by which a point may lie behind the front layer, in sphere diameters, screen-space"
    )


class Layers(Strict):
    """How the second layer is found, and what the thicknesses other than the first interval need."""

    method: Literal["auto", "peel"] = Field(
        "auto", description="auto: back faces of a solid, else the peel; peel: always, to compare"
    )
    gap: Annotated[float, Field(gt=0, le=10)] = Field(
        0.05, description="bridged: width of a gap after which matter counts 1/e, in sphere diameters"
    )
    rays: Annotated[int, Field(ge=1, le=65536)] = Field(320, description="local: rays per vertex into the object")
    reach: Annotated[float, Field(gt=0, le=1)] = Field(
        0.5, description="local: distance from which on a ray counts no more, in sphere diameters"
    )
    faces: Annotated[int, Field(ge=4)] | None = Field(
        None, description="APPROXIMATE second layer from about so many faces; empty: all of them, exact"
    )
    resolution: Literal[1, 2, 4] = Field(
        1, description="n: APPROXIMATE second layer of a solid at every n-th sample across and down; 1: at all, exact"
    )
    depth: Literal["float32", "float16"] = Field(
        "float32", description="numbers that layers are kept in; float16: half the memory, depths to 1e-3 diameters"
    )


class Blur(Strict):
    """The depth-aware Gaussian over the second layer (thesis section 3.1, appendix C.2.2)."""

    enabled: bool = Field(True, description="false: the second layer is used as it is")
    step: Annotated[float, Field(gt=0, le=0.25)] = Field(
        1 / 256,
        description="standard deviation (5x5: between taps), in sphere diameters as seen at the sphere's centre",
    )
    kernel: Literal["5x5", "3x3", "9x9", "separable"] = Field(
        "5x5", description="taps that stand for the Gaussian; separable: a row of 5, then a column of 5"
    )
    depth_range: Annotated[float, Field(gt=0, le=1)] = Field(
        0.10, description="depth difference at which a tap's weight reaches 0, in sphere diameters"
    )


class Scene(Strict):
    """One picture, complete: equal scenes give equal bytes on one OpenGL renderer."""

    object: str = Field("figure", description='built-in name, "name:faces", or a mesh file')
    size: tuple[Pixels, Pixels] = Field((512, 512), description="width, height in pixels")
    style: Literal["default", "as published"] = Field(
        "default", description="as published: the 2011 program's deterministic flaws (docs/technique.md)"
    )
    quality: Literal["interactive", "survey", "reference"] | None = Field(
        None, description="measured settings for every knob that the scene leaves alone (docs/accuracy.md); empty: none"
    )
    background: Albedo = Field((0.03, 0.03, 0.03), description="linear RGB behind the object, 0..1")
    alpha: bool = Field(
        False, description="true: the background is left out and the file keeps coverage as alpha, to lay over another"
    )
    exposure: NonNegative = Field(0.9, description="factor on the object's radiance before display")
    supersampling: Annotated[int, Field(ge=1, le=8)] = Field(3, description="n: n x n samples a pixel, box filter")
    open_surface: Literal["thin", "thick"] = Field(
        "thin", description="thickness of a pixel with no second layer: thin 0 (a sheet), thick 1 (opaque)"
    )
    material: Material = Material()
    light: Light = Light()
    lights: Annotated[tuple[Light, ...], Field(max_length=MOST_LIGHTS - 1)] = Field((), description="further lights")
    shadow: Shadow = Shadow()
    camera: Camera = Camera()
    layers: Layers = Layers()
    occlusion: Occlusion = Occlusion()
    blur: Blur = Blur()

    @model_validator(mode="after")
    def as_good_as_asked(self) -> Self:
        """Fills what `quality` settles."""
        if self.quality and self.style == "as published":
            raise ValueError(f'quality "{self.quality}" contradicts style "as published"; leave one of them out')
        if self.quality:
            from fakesss.quality import fill  # which most scenes never need

            fill(self)
        return self

    @model_validator(mode="after")
    def published_as_it_was(self) -> Self:
        """The published technique had none of the cheaper layers."""
        asked = {
            "blur.kernel": self.blur.kernel,
            "layers.resolution": self.layers.resolution,
            "layers.depth": self.layers.depth,
        }
        had = {"blur.kernel": "5x5", "layers.resolution": 1, "layers.depth": "float32"}
        for path, value in asked.items():
            if self.style == "as published" and value != had[path]:
                raise ValueError(
                    f'style "as published" has {path} = {json.dumps(had[path])}, not {json.dumps(value)}; leave it out'
                )
        return self

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """The scene in a TOML file (the fields of `[scene]` at top level); a mesh path is relative to the file."""
        path = Path(path)
        scene = cls.from_dict(read_toml(path), str(path))
        return scene.relative_to(path.parent)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], source: str) -> Self:
        """The scene described by `data`; errors name `source`, the key and the mend."""
        return validated(cls, data, source)

    def relative_to(self, folder: Path) -> Self:
        """The same scene with a mesh file's path taken from `folder`, and from nowhere else; built-in names stay."""
        from fakesss.shapes import is_mesh_file  # slow to import, and not needed to read a scene

        return self.model_copy(update={"object": str(folder / self.object)}) if is_mesh_file(self.object) else self

    def replace(self, changes: Mapping[str, Any] | Sequence[tuple[str, Any]], source: str = "scene") -> Self:
        """A copy with `{"material.backlight": 0.8}` applied and checked again.

        The changes are made in their order: one may name a light that an earlier one added. Pairs may change one
        field again.
        """
        from fakesss.quality import check_fills, forget  # which most scenes never need

        data = self.model_dump(exclude_unset=True)  # what a quality fills, it fills again
        asked = dict(changes)
        if "quality" in asked and asked["quality"] != self.quality:
            forget(self, data)
        for path, value in changes.items() if isinstance(changes, Mapping) else changes:
            *parents, leaf = check_path(path, source, len(data.get("lights", ()))).split(".")
            place: Any = data
            for parent in parents:
                place = place[int(parent)] if parent.isdecimal() else place.setdefault(parent, {})
            # later paths reach into the lights, so they must be lights; other fields may depend on later changes
            place[leaf] = self.from_dict({path: value}, source).model_dump()[path] if path == "lights" else value
        made = self.from_dict(data, source)
        if "quality" in asked:
            check_fills(made, source)
        return made

    def at(self, path: str) -> Any:
        """The value of the field at `path`, for example `material.backlight` or `lights.0.diffuse`."""
        value: Any = self
        for part in path.split("."):
            value = value[int(part)] if part.isdecimal() else getattr(value, part)
        return value

    def sha256(self) -> str:
        """Hash of every field, for naming and for telling stale pictures."""
        return hashlib.sha256(json.dumps(self.model_dump(mode="json"), sort_keys=True).encode()).hexdigest()


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file, or `BadInput` naming the file and the line."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; check the path") from None
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: cannot be read ({error}); it must be a readable UTF-8 text file") from None
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{path}: not valid TOML: {error}") from None


def scene_paths(model: type[BaseModel] = Scene, prefix: str = "") -> Iterator[str]:
    """Every path a factor may vary: `material.backlight`, `size`, ..."""
    for name, field in model.model_fields.items():
        inner = field.annotation
        if isinstance(inner, type) and issubclass(inner, BaseModel):
            yield from scene_paths(inner, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}"


def light_paths(number: int) -> Iterator[str]:
    """The paths of the fields of `number` further lights: `lights.0.azimuth`, ..."""
    for index in range(number):
        yield from scene_paths(Light, f"lights.{index}.")


def check_path(path: str, source: str, lights: int) -> str:
    """`path` if it is a field of a scene with so many further lights, otherwise `BadInput` with the nearest one."""
    known = [*scene_paths(), *light_paths(lights)]
    if path in known:
        return path
    if re.match(r"lights\.\d+(\.|$)", path) and int(path.split(".")[1]) >= lights:
        has = f"has {lights} of them" if lights else "has none"
        raise BadInput(f'{source}: path "{path}": counts from lights.0, and the scene {has}; add a [[lights]] table')
    raise BadInput(f'{source}: path "{path}" is no scene field; {nearest(path, known)}')
