"""Commands that measure: bench, tradeoff."""

import json
import math
import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from fakesss.cli import AS_JSON, commands, done, say
from fakesss.cli_picture import scene_named
from fakesss.output import check_writable, make_folder, write_atomically


@commands.command()
@click.option("--object", "name", default="figure", show_default=True, help="A built-in object.")
@click.option("--faces", multiple=True, type=click.IntRange(1000, 1_000_000), help="How many; again for more sizes.")
@click.option(
    "--side", default=512, show_default=True, type=click.IntRange(1, 4096), help="Of the square picture, pixels."
)
@click.option("-o", "--out", type=click.Path(file_okay=False), help="A folder for bench.json and bench.md.")
@AS_JSON
def bench(name: str, faces: tuple[int, ...], side: int, out: str | None, as_json: bool) -> None:
    """Measure what the technique costs beside direct light, and baking beside bare ray casting.

    Example: fakesss bench --faces 4000 --faces 60000 -o bench
    """
    from fakesss.bench import FACES
    from fakesss.bench import bench as measured
    from fakesss.bench_tables import tables

    files = places(Path(out)) if out else None
    result = measured(name, faces or FACES, (side, side))
    text = tables(result)
    if files:
        write_atomically(files[0], (json.dumps(result, indent=1) + "\n").encode())
        write_atomically(files[1], (text + "\n").encode())
    done(result, as_json, text)


def places(folder: Path) -> tuple[Path, Path]:
    """Where bench.json and bench.md go, the folder made if it is not there; asked for before the work, not after it."""
    make_folder(folder)
    figures, tables = folder / "bench.json", folder / "bench.md"
    check_writable(figures)
    check_writable(tables)
    return figures, tables


def finite(context: click.Context, option: click.Parameter, value: float) -> float:
    """`value`, unless it is nan or infinite, which `FloatRange` lets pass."""
    if not math.isfinite(value):
        raise click.BadParameter(f"{value} is no number of milliseconds; give one above 0", context, option)
    return value


@commands.command()
@click.argument("scenes", nargs=-1, required=True, metavar="SCENE...")
@click.option("--set", "changes", multiple=True, metavar="PATH=VALUE", help="Change one field of the scene.")
@click.option("--size", metavar="WxH", help="Pixels, for example 512x512.")
@click.option("--knob", "names", multiple=True, metavar="NAME", help="Only this one; again for more.")
@click.option("--quick", is_flag=True, help="Six rounds instead of fifteen, and few combinations: a first look.")
@click.option(
    "--budget-ms", default=33.0, show_default=True, type=click.FloatRange(0.1), callback=finite,
    help="Of the interactive preset.",
)  # fmt: skip
@click.option("-o", "--out", default="tradeoff", show_default=True, type=click.Path(file_okay=False), help="A folder.")
@click.option("--presets-out", type=click.Path(dir_okay=False), help="Write the presets as fakesss/presets.toml is.")
@AS_JSON
def tradeoff(
    scenes: tuple[str, ...],
    changes: tuple[str, ...],
    size: str | None,
    names: tuple[str, ...],
    quick: bool,
    budget_ms: float,
    out: str,
    presets_out: str | None,
    as_json: bool,
) -> None:
    """Measure what accuracy costs in time: every knob, combinations, and three presets.

    Writes index.html, tradeoff.json and tradeoff.csv. Several scenes get a folder each, and presets for the worst of
    them. The exact picture it compares with takes minutes, and is kept; an interrupted run continues.

    Example: fakesss tradeoff figure --size 256x256 --quick -o tradeoff
    """
    from fakesss.accuracy.tradeoff import QUICK, THOROUGH
    from fakesss.accuracy.tradeoff import tradeoff as measured
    from fakesss.accuracy.tradeoff_document import as_text, documents

    folders = folders_of(Path(out), scenes)
    if presets_out:
        check_writable(Path(presets_out))
    described = [scene_named(name, changes, size) for name in scenes]
    found = measured(described, names, QUICK if quick else THOROUGH, budget_ms)
    made = documents(found, scenes, command_line())
    for document, place, folder in zip(made, found.places, folders, strict=True):
        write_tradeoff(document, place, folder)
        say(f"{folder / 'index.html'}: what accuracy costs in time")
    if presets_out:
        write_atomically(Path(presets_out), presets_text(found, scenes, made[0]).encode())
    found.kept.forget()
    done(made[0] if len(made) == 1 else {"scenes": made}, as_json, "\n".join(map(as_text, made)))


def folders_of(out: Path, scenes: Sequence[str]) -> list[Path]:
    """A folder of each scene, made now: `out` itself for one, numbered ones in it for several."""
    several = [out / f"{number}-{Path(name.partition(':')[0]).stem}" for number, name in enumerate(scenes, 1)]
    folders = several if len(scenes) > 1 else [out]
    for folder in folders:
        make_folder(folder / "figures")
        for name in ("index.html", "tradeoff.json", "tradeoff.csv", "figures/any.svg"):
            check_writable(folder / name)
    return folders


def write_tradeoff(document: Mapping[str, Any], place: Any, folder: Path) -> None:
    """The document as JSON, as CSV and as a page."""
    from fakesss.accuracy.page import write_page
    from fakesss.accuracy.tradeoff import pictures
    from fakesss.accuracy.tradeoff_document import as_csv

    write_atomically(folder / "tradeoff.json", (json.dumps(document, indent=1) + "\n").encode())
    write_atomically(folder / "tradeoff.csv", as_csv(document).encode())
    write_page(document, folder, pictures(place))


def presets_text(found: Any, scenes: Sequence[str], document: Mapping[str, Any]) -> str:
    """The presets as a file that `quality` reads."""
    from fakesss.accuracy.presets import as_toml

    by = {key: document[key] for key in ("command", "date", "machine")}
    rounds = {"rounds": {"knobs": found.effort.rounds, "combinations": found.effort.again}}
    size = list(found.scenes[0].size)
    return as_toml(found.presets, found.asked, {**by, "scenes": list(scenes), "size": size, **rounds})


def command_line() -> str:
    """What was typed."""
    return shlex.join(["fakesss", *sys.argv[1:]])
