"""Commands about pictures and this machine: render, explain, bake, doctor."""

import re
import sys
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Literal

import click

from fakesss.cli import AS_JSON, commands, done, say
from fakesss.problem import BadInput

STUDY_KEYS = {"title", "scene", "factor", "question"}  # a scene file has none of them


def drawing(command: Callable[..., None]) -> Callable[..., None]:
    """The argument and options that name a scene."""
    for option in (
        click.argument("scene"),
        click.option("--set", "changes", multiple=True, metavar="PATH=VALUE", help="Change one field of the scene."),
        click.option("--size", metavar="WxH", help="Pixels, for example 512x512."),
    ):
        command = option(command)
    return command


def path_tracing(command: Callable[..., None]) -> Callable[..., None]:
    """The options of a path-traced picture; what is not given is as `PathTracing` has it."""
    for option in (
        click.option("--denoise", is_flag=True, default=None, help="Path-traced: smooth the grain by a network."),
        click.option("--no-highlights", is_flag=True, default=None, help="Path-traced: without the shader's gloss."),
        click.option("--seed", type=int, help="Path-traced: of the random numbers. [default: 0]"),
        click.option("--size-mm", type=float, help="Path-traced: diameter of the bounding sphere, mm. [default: 30]"),
        click.option("--noise", type=float, help="Path-traced: stop at this RMS error over RMS radiance."),
        click.option("--samples", type=int, help="Path-traced: per pixel, at most. [default: 256; with --noise 4096]"),
        click.option("--path-traced", "medium", metavar="MEDIUM", help="Path-trace a measured medium, or opaque."),
    ):
        command = option(command)
    return command


@commands.command()
@drawing
@click.option("-o", "--out", default="image.png", show_default=True, help="A .png (8-bit sRGB) or .exr (linear float).")
@click.option("--views", is_flag=True, help="A contact sheet of the intermediates instead of the picture.")
@path_tracing
@AS_JSON
def render(
    scene: str,
    changes: tuple[str, ...],
    size: str | None,
    out: str,
    views: bool,
    as_json: bool,
    medium: str | None,
    **options: Any,
) -> None:
    """Draw one picture of SCENE: a TOML file, a mesh file, a built-in object, or STUDY#stimulus-id.

    With --json it is drawn twice, and each pass's GPU time is of the second drawing.
    With --path-traced it is a physical medium's, slow and noisy; interrupted, the same command goes on.

    \b
    Example: fakesss render bunny.ply --set material.backlight=0.8 --size 317x211 -o bunny.png
    Example: fakesss render figure --size 256x256 --path-traced marble --noise 0.05 -o marble.png
    """
    tracing = {name: value for name, value in options.items() if value is not None}
    if medium is not None or tracing:
        trace(scene_named(scene, changes, size), medium, tracing, out, views, as_json)
        return
    from fakesss.renderer import render_file

    result = render_file(scene_named(scene, changes, size), out, views, timed=as_json)
    for warning in result["warnings"]:
        say(warning)
    done(result, as_json, f"{result['image']}: {result['width']}x{result['height']}, {result['gl_renderer']}")
    sys.exit(1 if result["non_finite"] else 0)


def trace(scene: Any, medium: str | None, tracing: Mapping[str, Any], out: str, views: bool, as_json: bool) -> None:
    """`render` with --path-traced."""
    from fakesss.offline.picture_file import traced_file
    from fakesss.offline.settings import PathTracing
    from fakesss.problem import validated

    if medium is None:
        given = ", ".join(f"--{name.replace('_', '-')}" for name in tracing)
        raise BadInput(f"{given}: belongs to path-traced pictures; add --path-traced MEDIUM")
    if views:
        raise BadInput("--views: a path-traced picture has no intermediates; leave out one of --views, --path-traced")
    asked = {"medium": medium, **tracing}
    if asked.pop("no_highlights", False):
        asked["highlights"] = False
    settings = validated(PathTracing, asked, "--path-traced")
    result = traced_file(scene, settings, out)
    for warning in result["warnings"]:
        say(warning)
    spent = "from the cache" if result["cached"] else f"{result['seconds']:.1f} s in all"
    size = f"{result['width']}x{result['height']}"
    noise = "unknown" if result["noise"] is None else f"{result['noise']:.2%}"
    grain = ", denoised" if result["denoised"] else ""
    done(result, as_json, f"{out}: {size}, {result['samples']} samples, noise {noise}{grain}, {spent}")


@commands.command()
@drawing
@click.option("--time/--no-time", "timed", default=False, help="Draw twice and report the GPU times of the second.")
@click.option("--savings", is_flag=True, help="Measure what leaving out each effect of no weight saves.")
@click.option("--graph", is_flag=True, help="Graphviz source of the frame graph, culled passes dashed.")
@click.option("-o", "--out", help="Draw the frame graph: a .svg, .pdf or .png.")
@AS_JSON
def explain(
    scene: str,
    changes: tuple[str, ...],
    size: str | None,
    timed: bool,
    savings: bool,
    graph: bool,
    out: str | None,
    as_json: bool,
) -> None:
    """List the passes of SCENE: kept or culled, why, what each reads and writes.

    Example: fakesss explain figure --set material.backlight=0 -o graph.svg
    """
    from fakesss import inspect
    from fakesss.explanation import explained, saved

    described = scene_named(scene, changes, size)
    if out:
        from fakesss.graph_drawing import check_drawing, draw_graph  # loads matplotlib

        check_drawing(out)
    plan = inspect.compiled(described)
    result = inspect.document(plan, described, timed)
    if out:
        draw_graph(plan, out, {entry["name"]: entry["gpu_ms"] for entry in result["passes"]})
        say(f"{out}: the frame graph")
    if savings:
        result["savings"] = inspect.savings(described)
    if graph:
        done(result, as_json, inspect.graph(described))
        return
    lines = [*explained(plan, result), *saved(result.get("savings"))]
    done(result, as_json, "\n".join(lines))


@commands.command()
@click.argument("mesh")
@click.option("--rays", default=320, show_default=True, type=click.IntRange(1), help="Rays per vertex.")
@click.option("--sampling", default="cosine", show_default=True, type=click.Choice(["cosine", "uniform"]))
@AS_JSON
def bake(mesh: str, rays: int, sampling: Literal["cosine", "uniform"], as_json: bool) -> None:
    """Bake the ambient occlusion of MESH (a file or a built-in object) into the cache.

    Example: fakesss bake knot:60000 --rays 1024
    """
    from fakesss.occlusion import bake_occlusion
    from fakesss.shapes import load_object

    baked = bake_occlusion(load_object(mesh), rays, sampling)
    result = {"mesh": mesh, "vertices": len(baked.values), "rays": rays, "sampling": sampling}
    result |= {"mean": float(baked.values.mean()), "seconds": baked.seconds, "cached": baked.cached}
    done(result, as_json, f"{mesh}: {len(baked.values)} vertices, {'cached' if baked.cached else 'baked'}")


@commands.command()
@AS_JSON
def doctor(as_json: bool) -> None:
    """Tell what this machine has of what a study needs, and which line mends what is missing.

    Example: fakesss doctor
    """
    from fakesss import doctor as examination

    findings = examination.look()
    result = examination.report(findings)
    done(result, as_json, "\n".join(examination.lines(findings)))
    sys.exit(0 if result["ok"] else 1)


def scene_named(name: str, changes: tuple[str, ...], size: str | None) -> Any:
    """The `Scene` that a command line argument means, with `--set` and `--size` applied."""
    from fakesss.scene import Scene, read_toml
    from fakesss.shapes import names

    path = Path(name)
    if "#" in name and not path.exists():
        scene = scene_of_stimulus(name)
    elif path.suffix == ".toml" and not path.is_dir():
        refuse_study(path, read_toml(path))
        scene = Scene.load(path)
    elif path.is_dir() and name not in names():
        raise is_folder(path)
    else:
        scene = Scene(object=name)
    scene = scene.replace([setting(text) for text in changes], "--set") if changes else scene
    return scene if size is None else scene.replace({"size": pixels(size)}, f'--size "{size}"')


def pixels(size: str) -> list[int]:
    """`512x512` as width and height."""
    if not re.fullmatch("[0-9]{1,9}x[0-9]{1,9}", size):
        raise BadInput(f'--size "{size}": write width x height in pixels, for example 512x512')
    return [int(side) for side in size.split("x")]


def refuse_study(path: Path, tables: Mapping[str, Any]) -> None:
    """`BadInput` where a TOML file holds a study, which is many pictures, instead of a scene."""
    if STUDY_KEYS & tables.keys():
        raise BadInput(f"{path}: is a study; build it and name one of its pictures, for example {path.parent}#img01")


def is_folder(path: Path) -> BadInput:
    """What is to be said of a folder where a scene is asked for."""
    if (path / "study.toml").is_file():
        return BadInput(f"{path}: is a study; build it and name one of its pictures, for example {path}#img01")
    return BadInput(f"{path}: is a folder; name a scene's TOML file, a mesh file or a built-in object")


def setting(text: str) -> tuple[str, Any]:
    """`material.backlight=0.8` as path and value; the value is TOML, or text where it is none."""
    path, equals, value = text.partition("=")
    if not equals:
        raise BadInput(f'--set "{text}": write path=value, for example material.backlight=0.8')
    try:
        return path.strip(), tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return path.strip(), value.strip()


def scene_of_stimulus(name: str) -> Any:
    """The scene behind one stimulus of a built study: `STUDY#img03`."""
    from fakesss.problem import nearest
    from fakesss.scene import Scene
    from stimuli.manifest import read_manifest

    folder, _, identity = name.rpartition("#")
    entries = {entry["id"]: entry for entry in read_manifest(Path(folder))["stimuli"]}
    if identity not in entries:
        raise BadInput(f'{folder}: no stimulus "{identity}"; {nearest(identity, entries)}')
    if entries[identity]["scene"] is None:
        raise BadInput(f"{name}: was made elsewhere, there is no scene to draw; name one of the study's own pictures")
    if entries[identity].get("origin"):
        say(f"{name}: is path-traced in the study; this is its scene as the shader draws it")
    return Scene.from_dict(entries[identity]["scene"], f"{folder}/stimuli/manifest.json").relative_to(Path(folder))
