"""Pictures of a homogeneous medium by path tracing: slow, resumable, with the noise they have left.

Same mesh, camera and lights as the shader's picture of the scene. What they leave out is said in their provenance.
"""

import time
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from fakesss import cache
from fakesss.camera import View
from fakesss.lighting_terms import alone
from fakesss.media import Medium, medium_named, sigma_t_prime
from fakesss.mesh import Mesh
from fakesss.offline.denoising import check_denoiser, denoised, denoiser
from fakesss.offline.physical_scene import physical_scene
from fakesss.offline.settings import OPAQUE, ROUND, PathTracing
from fakesss.offline.silhouette import Silhouette, silhouette
from fakesss.offline.tally import Shelf, Tally
from fakesss.offline.tracer import VARIANT, Tracer
from fakesss.problem import BadInput
from fakesss.scene import Scene
from fakesss.shapes import load_object
from fakesss.solidity import is_solid

__all__ = ["OPAQUE", "PathTraced", "PathTracing", "path_traced"]

Float32 = NDArray[np.float32]

VERSION = 1  # raised whenever the radiance changes, so that kept rounds are not gone on from
KEEP_EVERY = 10.0  # seconds between two tallies kept
LEFT_OUT = (
    "refraction and reflection at the boundary (index-matched)",
    "the phase function (isotropic, reduced scattering coefficient)",
)


@dataclass(frozen=True)
class PathTraced:
    """A path-traced picture, and how sure it is."""

    image: Float32  # (H, W, 4): linear RGB over the background, and coverage, as `fakesss.render` gives it
    standard_error: Float32  # (H, W, 3), of its RGB
    noise: float  # RMS standard error over RMS radiance of the object without highlights, pixels it covers
    samples: int  # per pixel
    seconds: float  # of tracing, all sessions together
    cached: bool  # nothing was traced this time
    provenance: dict[str, Any]


def path_traced(scene: Scene, settings: PathTracing, *, quiet: bool | None = None) -> PathTraced:
    """The picture of `scene` filled with a medium. Goes on from the rounds kept by earlier sessions.

    Equal settings give equal bytes, however often they were interrupted. `quiet`: without a progress bar; None:
    with one on a terminal only. Raises `BadInput` for what no physical scene can be.
    """
    medium = None if settings.medium == OPAQUE else medium_named(settings.medium, "medium")
    mesh = load_object(scene.object)
    check(scene, mesh, medium)
    if settings.denoise:
        check_denoiser()
    extinction = None if medium is None else per_radius(medium, settings.size_mm)
    outline = silhouette(mesh, View.of(scene.camera, scene.size), scene.size, extinction)
    shelf = Shelf(kept_at(scene, mesh, medium, settings), scene.size)
    tally = kept(shelf, settings)
    cached = tally.rounds == settings.rounds(tally.noises)
    if not cached:
        tracer = Tracer(scene, mesh, medium, settings.size_mm, settings.seed)
        go_on(tally, tracer, outline.coverage > 0, settings, shelf, quiet)
    return finished(scene, mesh, medium, settings, tally, outline, cached)


def check(scene: Scene, mesh: Mesh, medium: Medium | None) -> None:
    """`BadInput` for an object or a camera that the path tracer has no answer to."""
    if medium is not None and not mesh.watertight:
        raise BadInput(
            f"scene: object {scene.object!r}: its surface is open, and a medium needs a closed one; close the mesh"
        )
    if View.of(scene.camera, scene.size).clips_sphere:
        raise BadInput(
            "scene: camera: its clip planes may cut the object open, and path-traced pictures show it whole; leave "
            "near and far empty and distance above 1"
        )


def per_radius(medium: Medium, size_mm: float) -> NDArray[np.float64]:
    """Reduced extinction (3,) in a bounding sphere of `size_mm`, 1/radius."""
    return sigma_t_prime(medium.sigma_s_prime, medium.sigma_a) * size_mm / 2


def kept_at(scene: Scene, mesh: Mesh, medium: Medium | None, settings: PathTracing) -> Any:
    """The folder of everything with this radiance; samples, noise, exposure, background and highlights change none."""
    try:
        mitsuba = version("mitsuba")
    except PackageNotFoundError:
        raise BadInput("path tracing: Mitsuba is not installed; pip install 'fakesss[offline]'") from None
    view = View.of(scene.camera, scene.size)
    key = {
        "version": VERSION,
        "mitsuba": [mitsuba, VARIANT, ROUND],
        "mesh": mesh.sha256,
        "view": [view.rotation.tolist(), view.distance, view.tangent, scene.size],
        "physical": physical_scene(scene, medium, settings.size_mm),
        "seed": settings.seed,
    }
    return cache.entry("path-traced", key).with_suffix("")


def kept(shelf: Shelf, settings: PathTracing) -> Tally:
    """The fullest kept tally that these settings pass through, an empty one if there is none."""
    tallies = sorted(shelf.tallies(), key=lambda tally: tally.rounds)
    if not tallies:
        return Tally.empty(shelf.size)
    end = settings.rounds(tallies[-1].noises)
    return next((tally for tally in reversed(tallies) if tally.rounds <= end), Tally.empty(shelf.size))


def go_on(
    tally: Tally,
    tracer: Tracer,
    covered: NDArray[np.bool_],
    settings: PathTracing,
    shelf: Shelf,
    quiet: bool | None,
) -> None:
    """Add rounds until the settings are met. What was added is kept on the way and when interrupted."""
    done = tally.rounds * ROUND
    label = f"{settings.medium} by path tracing"
    with tqdm(total=settings.samples, initial=done, unit="sample", desc=label, disable=quiet) as bar:
        saved = time.perf_counter()
        try:
            while tally.rounds < settings.rounds(tally.noises):
                started = time.perf_counter()
                radiance = tracer(tally.rounds)
                now = time.perf_counter()
                tally.add(radiance, covered, now - started)
                bar.update(ROUND)
                bar.set_postfix(noise=f"{tally.noises[-1]:.2%}")
                if now - saved > KEEP_EVERY:
                    shelf.keep(tally, finished=False)
                    saved = now
        except BaseException:
            shelf.keep(tally, finished=False)
            raise
    shelf.keep(tally, finished=True)


def finished(
    scene: Scene,
    mesh: Mesh,
    medium: Medium | None,
    settings: PathTracing,
    tally: Tally,
    outline: Silhouette,
    cached: bool,
) -> PathTraced:
    """The tally as a picture: exposed, over the background, denoised if asked for, with highlights."""
    rgb = scene.exposure * tally.mean
    if not scene.alpha:
        rgb += np.array(scene.background) * (1 - outline.coverage[..., None] + outline.through)
    if settings.denoise:
        rgb = denoised(rgb, outline.coverage)
    if settings.highlights:
        rgb += highlights(scene)
    image = np.concatenate([rgb, outline.coverage[..., None]], axis=2).astype(np.float32)
    error = (scene.exposure * tally.standard_error).astype(np.float32)
    facts = provenance(scene, mesh, medium, settings, tally)
    return PathTraced(image, error, tally.noises[-1], tally.rounds * ROUND, tally.seconds, cached, facts)


def highlights(scene: Scene) -> NDArray[np.float64]:
    """The shader's specular term (H, W, 3), exposed and times coverage."""
    from fakesss.renderer import shared_renderer  # opens OpenGL

    alone_over_nothing = alone(scene, "specular").replace({"alpha": True})
    return shared_renderer().render(alone_over_nothing).image[..., :3].astype(np.float64)


def provenance(scene: Scene, mesh: Mesh, medium: Medium | None, settings: PathTracing, tally: Tally) -> dict[str, Any]:
    """Where the picture comes from, and what it leaves out; JSON."""
    left_out = [] if medium is None else list(LEFT_OUT)
    if settings.highlights:
        left_out.append("physical highlights (the shader's specular term is added)")
    if medium is not None and scene.alpha:
        left_out.append("the background that shines through unscattered (alpha)")
    if medium is not None and not is_solid(mesh):
        left_out.append("parts that overlap (the medium ends where the first of them is left)")
    return {
        "renderer": "path-traced",
        "mitsuba": version("mitsuba"),
        "variant": VARIANT,
        **settings.model_dump(mode="json", exclude={"noise", "samples", "denoise"}),
        "sigma_s_prime": medium and list(medium.sigma_s_prime),
        "sigma_a": medium and list(medium.sigma_a),
        "samples": tally.rounds * ROUND,
        "noise": tally.noises[-1],
        "seconds": tally.seconds,
        "scene_sha256": scene.sha256(),
        "mesh_sha256": mesh.sha256,
        "denoised": denoiser() if settings.denoise else False,
        "leaves_out": left_out,
    }
