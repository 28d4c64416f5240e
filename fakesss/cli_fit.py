"""The command about the distance to ground truth: fit."""

import shlex
import sys
from pathlib import Path
from typing import Any

import click

from fakesss.cli import AS_JSON, commands, done, say
from fakesss.cli_picture import drawing, scene_named


@commands.command()
@drawing
@click.option("--to", "medium", required=True, metavar="MEDIUM", help="A measured medium, for example medium.marble.")
@click.option("--size-mm", default=30.0, show_default=True, help="Diameter of the object's bounding sphere.")
@click.option("--samples", type=int, help="Of the path-traced picture, per pixel.  [default: 256; with --noise 4096]")
@click.option("--noise", type=float, help="Trace until the picture's relative noise is no more than this.")
@click.option(
    "--starts", default=8, show_default=True, type=click.IntRange(1, 1000), help="For each kind of thickness."
)
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0, 2**32 - 1), help="Of starts and paths.")
@click.option(
    "-o", "--out", type=click.Path(file_okay=False, path_type=Path), help="A folder for scene, numbers, page."
)
@AS_JSON
def fit(
    scene: str,
    changes: tuple[str, ...],
    size: str | None,
    medium: str,
    size_mm: float,
    samples: int | None,
    noise: float | None,
    starts: int,
    seed: int,
    out: Path | None,
    as_json: bool,
) -> None:
    """Find the shader parameters that come nearest to the path-traced picture of SCENE made of a measured medium.

    Writes fitted.toml, which `fakesss render` draws, and what is left over: errors, times, pictures. Path tracing is
    slow; interrupted, the same command continues. It needs the extra `offline`.

    Example: fakesss fit figure --to medium.marble --size 128x128 --samples 64 -o marble
    """
    from fakesss.media import medium_named
    from fakesss.offline.fit_files import check_folder, write_report
    from fakesss.offline.fit_report import Named, fit_medium
    from fakesss.offline.settings import PathTracing
    from fakesss.problem import validated

    described = scene_named(scene, changes, size)
    known = medium_named(medium, "--to").name
    asked = {"medium": known, "size_mm": size_mm, "samples": samples, "noise": noise, "seed": seed}
    given = {name: value for name, value in asked.items() if value is not None}
    settings = validated(PathTracing, given, "fit")
    if out:
        check_folder(out)
    named = Named(Path(scene).name, shlex.join(["fakesss", *sys.argv[1:]]))
    report = fit_medium(described, settings, starts, seed, named)
    for note in report.document["notes"]:
        say(note)
    if out:
        write_report(report, out)
    done(report.document, as_json, "\n".join(lines(report.document)))


def lines(document: dict[str, Any]) -> list[str]:
    """What a person reads: the parameters, and the sentence."""
    rows = [f"{'':30}{'start':>24}{'fitted':>24}"]
    for path, entry in {**document["parameters"], "material.thickness": document["thickness"]}.items():
        rows.append(f"{path:30}{shown(entry['start']):>24}{shown(entry['fitted']):>24}")
    return [*rows, document["sentence"]]


def shown(value: Any) -> str:
    """A parameter in four digits."""
    if isinstance(value, list):
        return " ".join(f"{channel:.4g}" for channel in value)
    return value if isinstance(value, str) else f"{value:.4g}"
