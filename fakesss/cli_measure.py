"""Commands that measure: bench."""

import json
from pathlib import Path
from typing import Any

import click

from fakesss.cli import AS_JSON, commands, done
from fakesss.problem import BadInput


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

    folder = folder_for(out) if out else None
    result = measured(name, faces or FACES, (side, side))
    text = tables(result)
    if folder:
        write(folder, result, text)
    done(result, as_json, text)


def folder_for(path: str) -> Path:
    """The folder, made if it is not there; asked for before the work, not after it."""
    try:
        Path(path).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BadInput(f"{path}: cannot be made ({error.strerror}); name a folder that can be written") from None
    return Path(path)


def write(folder: Path, result: dict[str, Any], text: str) -> None:
    """The figures for machines and for people."""
    (folder / "bench.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    (folder / "bench.md").write_text(text + "\n", encoding="utf-8")
