"""The object: loaded, repaired, recentred and scaled once, kept for the pictures that follow."""

from collections.abc import Hashable
from pathlib import Path

from fakesss.frame_graph import Bake
from fakesss.scene import Scene
from fakesss.shapes import load_object

EXACT = "takes the object as it is"


def mesh(scene: Scene) -> Bake:
    """Writes `mesh`, a `fakesss.mesh.Mesh`."""
    return Bake("mesh", make=lambda inputs: load_object(scene.object), key=lambda inputs: identity(scene.object))


def identity(name: str) -> Hashable:
    """A built-in object is its name; a file also its size and time of change, so that an edited mesh is read again."""
    path = Path(name)
    if not path.is_file():
        return name
    status = path.stat()
    return str(path.resolve()), status.st_size, status.st_mtime_ns
