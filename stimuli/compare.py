"""`[[compare]]`: pictures of other origin, rated beside ours: files made elsewhere, and path-traced media."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from fakesss.offline.settings import PathTracing
from fakesss.problem import validated
from fakesss.scene import Scene
from stimuli.changes import changed
from stimuli.levels import written


class Compare(PathTracing):
    """A file of the study's picture size, or the study's scene filled with a medium and path-traced."""

    image: Annotated[str, Field(min_length=1)] | None = Field(None, description="file, relative to study.toml")
    renderer: Literal["path-traced"] | None = Field(None, description="instead of a file")
    label: str = Field("", description="name in tables; empty: the file's name, or path-traced and the medium's")
    medium: str = Field("", description=PathTracing.model_fields["medium"].description)
    set: dict[str, Any] = Field({}, description="scene field = value, as { light.azimuth = 180 }")

    @model_validator(mode="after")
    def _of_one_origin(self) -> Self:
        if self.image is None and self.renderer is None:
            raise ValueError('needs an origin: image = "file.png" or renderer = "path-traced"')
        if self.image is not None and self.renderer is not None:
            raise ValueError("has an image and a renderer; a picture is a file or path-traced, so remove one of them")
        strangers = sorted(self.model_fields_set - {"image", "label"})
        if self.image is not None and strangers:
            raise ValueError(f"{strangers[0]} is of path-traced pictures and this one is a file; remove it")
        if self.renderer is not None and "medium" not in self.model_fields_set:
            raise ValueError('medium is missing; add one, for example medium = "marble"')
        return self

    @property
    def name(self) -> str:
        """What tables call it; a denoised picture is marked."""
        name = self.label or self.image or f"path-traced {self.medium}"
        return f"{name}, denoised" if self.denoise and not name.endswith(", denoised") else name

    @property
    def where(self) -> str:
        """Its place in study.toml."""
        return f"study.toml: compare {written(self.name)}"

    @property
    def path_tracing(self) -> PathTracing | None:
        """How it is path-traced; None of a file."""
        if self.renderer is None:
            return None
        return validated(PathTracing, self.model_dump(include=set(PathTracing.model_fields)), self.where)

    def scene(self, base: Scene) -> Scene | None:
        """`base` with the fields set, or `BadInput` naming picture, field and mend; None of a file."""
        return None if self.renderer is None else changed(base, self.set, self.where)
