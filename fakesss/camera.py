"""The camera's frame, its clip planes and the two kinds of depth.

Eye frame: x right, y up, z towards the viewer; *depth* is the distance along the view axis, so it is positive in
front of the camera. Lengths are in radii of the object's bounding sphere, whose centre the camera looks at.
"""

import math
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from fakesss.scene import Camera

Float = NDArray[np.float64]

SPHERE_MARGIN = 1e-4  # radii; keeps vertices that lie on the sphere clear of rounding at the clip planes
NEAREST = 1e-3  # radii; no near plane is nearer: 24 bits of depth still part 1e-4 radii at depth 1


def direction(azimuth: float, elevation: float) -> Float:
    """Unit vector in the world frame: degrees around +y from +z towards +x, and degrees above the horizon."""
    a, e = math.radians(azimuth), math.radians(elevation)
    return np.array([math.sin(a) * math.cos(e), math.sin(e), math.cos(a) * math.cos(e)])


@dataclass(frozen=True, eq=False)
class View:
    """A camera, resolved for one picture size."""

    rotation: Float  # (3, 3), world frame to eye frame; rows are right, up, towards the viewer
    distance: float  # of the sphere's centre along the view axis, radii
    near: float  # clip distance, radii
    far: float  # clip distance, radii
    tangent: tuple[float, float]  # tangents of the half angles of the picture's width and height

    @classmethod
    def of(cls, camera: Camera, size: tuple[int, int]) -> Self:
        """The view of `camera` on a picture of `size` (width, height); the field of view is its shorter side's."""
        half = math.radians(camera.field_of_view) / 2
        distance = camera.distance if camera.distance is not None else 1 / math.sin(half)
        near = max(camera.near if camera.near is not None else distance - 1 - SPHERE_MARGIN, NEAREST)
        far = camera.far if camera.far is not None else max(distance + 1 + SPHERE_MARGIN, 2 * near)
        near = near if near < far else far / 2
        towards = direction(camera.azimuth, camera.elevation)
        right = direction(camera.azimuth + 90, 0)
        rotation = np.array([right, np.cross(towards, right), towards])
        shorter = min(size)
        tangent = (math.tan(half) * size[0] / shorter, math.tan(half) * size[1] / shorter)
        return cls(rotation, distance, near, far, tangent)

    @property
    def pose(self) -> bytes:
        """Equal poses put a mesh at equal eye coordinates."""
        return self.rotation.tobytes()

    @property
    def projection(self) -> dict[str, Any]:
        """The uniforms of `glsl/common_projection.glsl`."""
        near, far = self.drawn_between
        room = (self.distance - near, far - self.distance)
        return {"tangent": self.tangent, "planes": (near, far), "room": room, "distance": self.distance}

    @property
    def drawn_between(self) -> tuple[float, float]:
        """The near and far distances that the depth buffer spans.

        A plane that does not cut the sphere is moved up to it: nothing lies beyond, and the depth buffer parts more.
        Behind the sphere a radius is left free: in a triangle smaller than a pixel a rasteriser carries depth beyond
        that of the corners, and what it takes for farther than the far plane is lost.
        """
        near = self.near if self.near > self.distance - 1 else max(self.distance - 1 - SPHERE_MARGIN, NEAREST)
        far = self.far if self.far < self.distance + 1 else self.distance + 2
        return (near, far) if near < far else (self.near, self.far)

    @property
    def clips_sphere(self) -> bool:
        """Whether a clip plane may cut the object open. Fitted planes stand clear of the sphere by `SPHERE_MARGIN`."""
        return self.near > self.distance - 1 or self.far < self.distance + 1

    def to_eye(self, points: NDArray[Any]) -> NDArray[np.float32]:
        """World points (N, 3) as (x right, y up, depth beyond the sphere's centre) in float32, computed in float64."""
        return (self.turn(points) * (1, 1, -1)).astype(np.float32)

    def turn(self, vectors: NDArray[Any]) -> Float:
        """World vectors (N, 3) in the eye frame, float64. Summed by hand: BLAS may order the sum by thread count."""
        v = vectors.astype(np.float64)
        r = self.rotation
        return np.column_stack([v[:, 0] * r[i, 0] + v[:, 1] * r[i, 1] + v[:, 2] * r[i, 2] for i in range(3)])

    def in_picture(self, length: float) -> tuple[float, float]:
        """A length (radii) at the sphere's centre as shares of the picture's width and height.

        A camera inside the sphere sees it as from the sphere's surface, so the shares stay bounded.
        """
        distance = max(self.distance, 1.0)
        return length / (2 * distance * self.tangent[0]), length / (2 * distance * self.tangent[1])


def nonlinear_depth(depth: NDArray[Any] | float, near: float, far: float) -> Any:
    """OpenGL's window-space depth in 0..1 of an eye-space depth, inverse of `linear_depth` (thesis eq. 3.3)."""
    return far * (depth - near) / (np.asarray(depth) * (far - near))


def linear_depth(window: NDArray[Any] | float, near: float, far: float) -> Any:
    """Eye-space depth of a window-space depth in 0..1 (thesis eq. 3.3)."""
    return near * far / (far - np.asarray(window) * (far - near))
