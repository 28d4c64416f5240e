"""What a path-traced picture would take, before it is begun."""

from fakesss.offline.path_tracing import planned
from fakesss.offline.settings import PathTracing
from fakesss.scene import Scene


def is_kept(scene: Scene, settings: PathTracing) -> bool:
    """Whether `path_traced` would trace nothing, since the cache has all of its rounds.

    Raises `BadInput` where it would: an object that cannot be filled, a light that cannot be traced, no Mitsuba.
    """
    return planned(scene, settings).done
