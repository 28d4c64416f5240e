"""Pictures of a homogeneous medium by path tracing: slow, resumable, with the noise they have left.

Same mesh, camera and lights as the shader's picture of the scene. What they leave out is said in their provenance.
"""

import math
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
    noise: float  # RMS standard error over RMS radiance of the object without highlights, pixels it covers; or inf
    samples: int  # per pixel
    seconds: float  # of tracing, all sessions together
    cached: bool  # nothing was traced this time
    provenance: dict[str, Any]
    warnings: tuple[str, ...] = ()  # one sentence each


def path_traced(scene: Scene, settings: PathTracing, *, quiet: bool | None = None) -> PathTraced:
    """The picture of `scene` filled with a medium. Goes on from the rounds kept by earlier sessions.

    Equal settings give equal bytes, however often they were interrupted. `quiet`: without a progress bar; None:
    with one on a terminal only. Raises `BadInput` for what no physical scene can be.
    """
    plan = planned(scene, settings)
    gloss = highlights(scene) if settings.highlights else None  # before hours of tracing: there may be no OpenGL
    extinction = None if plan.medium is None else per_radius(plan.medium, settings.size_mm)
    outline = silhouette(plan.mesh, View.of(scene.camera, scene.size), scene.size, extinction)
    tally = plan.tally
    if not plan.done:
        tracer = Tracer(scene, plan.mesh, plan.medium, settings.size_mm, settings.seed)
        tally = go_on(tally, tracer, outline.coverage > 0, settings, plan.shelf, quiet)
    image = finished(scene, settings, tally, outline, gloss)
    error = (scene.exposure * tally.standard_error).astype(np.float32)
    samples, facts = tally.rounds * ROUND, provenance(scene, plan.mesh, plan.medium, settings, tally)
    warned = warnings(plan.mesh, plan.medium, settings, tally)
    return PathTraced(image, error, tally.noise, samples, tally.seconds, plan.done, facts, warned)


@dataclass(frozen=True)
class Plan:
    """What is to be traced, and what of it is there already."""

    medium: Medium | None  # None: opaque
    mesh: Mesh
    shelf: Shelf
    tally: Tally
    done: bool  # it has all the rounds that the settings ask for


def planned(scene: Scene, settings: PathTracing) -> Plan:
    """The plan; `BadInput` for what no physical scene can be, and for a package that is missing."""
    medium = None if settings.medium == OPAQUE else medium_named(settings.medium, "medium")
    mesh = load_object(scene.object)
    check(scene, mesh, medium)
    if settings.denoise:
        check_denoiser()
    shelf = Shelf(kept_at(scene, mesh, medium, settings), scene.size)
    tally = kept(shelf, settings)
    return Plan(medium, mesh, shelf, tally, 0 < tally.rounds == settings.rounds(tally.ratios))


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
    end = settings.rounds(tallies[-1].ratios)
    return next((tally for tally in reversed(tallies) if tally.rounds <= end), Tally.empty(shelf.size))


def go_on(
    tally: Tally,
    tracer: Tracer,
    covered: NDArray[np.bool_],
    settings: PathTracing,
    shelf: Shelf,
    quiet: bool | None,
) -> Tally:
    """`tally` and as many rounds more as the settings ask for. They are kept on the way and when interrupted."""
    done = tally.rounds * ROUND
    label = f"{settings.medium} by path tracing"
    with tqdm(total=settings.samples, initial=done, unit="sample", desc=label, disable=quiet) as bar:
        saved = time.perf_counter()
        try:
            while tally.rounds < settings.rounds(tally.ratios):
                started = time.perf_counter()
                radiance = tracer(tally.rounds)
                now = time.perf_counter()
                tally = tally.added(radiance, covered, now - started)
                bar.total = settings.foreseen(tally.rounds, tally.ratios[-1])
                bar.set_postfix(noise=f"{tally.noise:.2%}", refresh=False)
                bar.update(ROUND)
                if now - saved > KEEP_EVERY:
                    shelf.keep(tally, finished=False)
                    saved = now
        except BaseException:
            shelf.keep(tally, finished=False)
            raise
    shelf.keep(tally, finished=True)
    return tally


def finished(
    scene: Scene, settings: PathTracing, tally: Tally, outline: Silhouette, gloss: NDArray[np.float64] | None
) -> Float32:
    """The tally as a picture: exposed, over the background, denoised if asked for, with highlights."""
    rgb = scene.exposure * tally.mean
    if not scene.alpha:
        rgb += np.array(scene.background) * (1 - outline.coverage[..., None] + outline.through)
    if settings.denoise:
        rgb = denoised(rgb, outline.coverage)
    if gloss is not None:
        rgb += gloss
    return np.concatenate([rgb, outline.coverage[..., None]], axis=2).astype(np.float32)


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
        "noise": tally.noise if math.isfinite(tally.noise) else None,
        "seconds": tally.seconds,
        "scene_sha256": scene.sha256(),
        "mesh_sha256": mesh.sha256,
        "denoised": denoiser() if settings.denoise else False,
        "leaves_out": left_out,
    }


def warnings(mesh: Mesh, medium: Medium | None, settings: PathTracing, tally: Tally) -> tuple[str, ...]:
    """What a person should know of the picture, one sentence each."""
    said = []
    if not settings.met(tally.ratios[-1]):
        reached = f"{tally.noise:.2%}" if math.isfinite(tally.noise) else "unknown, as hardly any path met light"
        said.append(
            f"The noise after {settings.samples} samples is {reached}, not {settings.noise:.2%}; raise samples."
        )
    if medium is not None and not is_solid(mesh):
        said.append(
            "Parts of the object overlap: its medium ends where the first of them is left, and the background shines "
            "through as if each were by itself; join them to one surface."
        )
    return tuple(said)
