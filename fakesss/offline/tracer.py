"""Mitsuba itself: a scene loaded once, and its radiance in rounds of a few samples."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.media import Medium
from fakesss.mesh import Mesh
from fakesss.offline.physical_scene import RADIUS, physical_scene, sensor
from fakesss.offline.settings import ROUND
from fakesss.problem import BadInput
from fakesss.scene import Scene

Floats = NDArray[np.float64]

VARIANT = "scalar_rgb"  # works on any processor, and gives equal bytes on any number of threads


def mitsuba() -> Any:
    """The package in the variant used here, or `BadInput` with the line that installs it."""
    try:
        import mitsuba as package
    except ImportError:
        raise BadInput("path tracing: Mitsuba is not installed; pip install 'fakesss[offline]'") from None
    package.set_variant(VARIANT)
    package.set_log_level(package.LogLevel.Error)
    return package


class Tracer:
    """Radiance of a scene's object alone: `Tracer(scene, mesh, medium, size_mm, seed)(number)`."""

    def __init__(self, scene: Scene, mesh: Mesh, medium: Medium | None, size_mm: float, seed: int) -> None:
        self._mi, self._scene, self._seed = mitsuba(), scene, seed
        parts = physical_scene(scene, medium, size_mm)
        self._loaded = self._mi.load_dict({"type": "scene", **parts, "object": self._shape(mesh, parts["object"])})

    def __call__(self, number: int) -> Floats:
        """Mean radiance (H, W, 3) of round `number`, `ROUND` samples a pixel, 0 beside the object.

        Every round has random numbers of its own: a hash of the seed and its number starts the sampler.
        """
        own = int(np.random.SeedSequence([self._seed, number]).generate_state(1)[0])
        camera = sensor(self._scene, own)
        camera["to_world"] = self._mi.ScalarTransform4f(camera["to_world"])
        integrator = self._loaded.integrator()
        picture = integrator.render(self._loaded, sensor=self._mi.load_dict(camera), seed=0, spp=ROUND)
        return np.array(picture, np.float64)

    def _shape(self, mesh: Mesh, made_of: dict[str, Any]) -> Any:
        """The mesh with what it is made of."""
        properties = self._mi.Properties()
        for name, part in made_of.items():
            properties[name] = self._mi.load_dict(part)
        shape = self._mi.Mesh("object", len(mesh.positions), len(mesh.faces), has_vertex_normals=True, props=properties)
        arrays = self._mi.traverse(shape)
        arrays["vertex_positions"] = mesh.positions.ravel() * np.float32(RADIUS)
        arrays["vertex_normals"] = mesh.normals.ravel()
        arrays["faces"] = mesh.faces.astype(np.uint32).ravel()
        arrays.update()
        return shape
