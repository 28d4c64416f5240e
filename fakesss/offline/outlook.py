"""What a path-traced picture would take, before it is begun."""

from fakesss.media import medium_named
from fakesss.offline.denoising import check_denoiser
from fakesss.offline.path_tracing import check, kept, kept_at
from fakesss.offline.settings import OPAQUE, PathTracing
from fakesss.offline.tally import Shelf
from fakesss.scene import Scene
from fakesss.shapes import load_object


def is_kept(scene: Scene, settings: PathTracing) -> bool:
    """Whether `path_traced` would trace nothing, since the cache has all of its rounds.

    Raises `BadInput` where it would: an object that cannot be filled, a light that cannot be traced, no Mitsuba.
    """
    medium = None if settings.medium == OPAQUE else medium_named(settings.medium, "medium")
    mesh = load_object(scene.object)
    check(scene, mesh, medium)
    if settings.denoise:
        check_denoiser()
    tally = kept(Shelf(kept_at(scene, mesh, medium, settings), scene.size), settings)
    return 0 < tally.rounds == settings.rounds(tally.noises)
