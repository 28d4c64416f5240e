"""What a hard case is: what makes it hard, the file or the scene it needs, and what must come out."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fakesss.scene import Scene

EVERYDAY: dict[str, Any] = {
    "object": "knot:4000",
    "size": (96, 96),
    "supersampling": 2,
    "occlusion.rays": 64,
    "camera.azimuth": 10.0,
}


@dataclass(frozen=True)
class Case:
    """One thing that breaks renderers. Without `content` the object is a built-in one."""

    name: str
    why: str  # it is hard
    outcome: str  # what must come out; for a refusal, how its one sentence goes on after naming the place
    content: Callable[[], bytes] | None = None  # of the mesh file
    suffix: str = ""  # of the mesh file
    changes: Mapping[str, Any] = field(default_factory=dict)  # of the everyday scene
    closed: bool = True  # whether the surface is
    refused: bool = False  # exit 2 instead of a picture
    empty: bool = False  # no pixel shows the object, and a warning says so

    def __str__(self) -> str:
        return self.name

    def write(self, folder: Path) -> str:
        """The scene's `object`; where the case has a mesh file of its own, it is written into `folder`."""
        if self.content is None:
            return str(self.changes.get("object", EVERYDAY["object"]))
        path = folder / f"{self.name}{self.suffix}"
        if not path.exists():
            path.write_bytes(self.content())
        return str(path)

    def scene(self, folder: Path) -> Scene:
        """The scene of the case; `BadInput` already here where it is the scene that is refused."""
        return Scene().replace({**EVERYDAY, **self.changes, "object": self.write(folder)}, self.name)
