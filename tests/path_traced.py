"""A path-traced picture of 16 x 12 pixels whose truth is known: a white medium in a white furnace."""

import pytest

from fakesss.media import MEDIA, Medium
from fakesss.offline.path_tracing import PathTraced, PathTracing, path_traced
from fakesss.scene import Scene

CLEAR = Medium("clear", (2.0, 4.0, 8.0), (0.0, 0.0, 0.0), 1.0)
FURNACE = {"ambient": (1.0, 1.0, 1.0), "diffuse": (0.0, 0.0, 0.0), "specular": (0.0, 0.0, 0.0)}
WHITE = {"light": FURNACE, "background": (1.0, 1.0, 1.0), "exposure": 1.0}
SCENE = Scene.from_dict({"object": "sphere:4000", "size": (16, 12), **WHITE}, "test")


def with_clear_medium(monkeypatch: pytest.MonkeyPatch) -> None:
    """Puts `CLEAR`, which absorbs nothing, among the media."""
    monkeypatch.setitem(MEDIA, "clear", CLEAR)  # type: ignore[arg-type]


def traced(samples: int, **more: object) -> PathTraced:
    """The sphere of `CLEAR`, or of another medium."""
    settings = {"medium": "clear", "size_mm": 2.0, "highlights": False, **more}
    return path_traced(SCENE, PathTracing.model_validate({"samples": samples, **settings}), quiet=True)


def equal(a: PathTraced, b: PathTraced) -> bool:
    """Whether two pictures are the same to the bit, as sure of themselves, and of as many samples."""
    same = a.image.tobytes() == b.image.tobytes() and a.standard_error.tobytes() == b.standard_error.tobytes()
    return same and (a.samples, a.noise) == (b.samples, b.noise)
