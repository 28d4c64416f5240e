"""Commands that measure: bench."""

import json
from pathlib import Path

import click

from fakesss.cli import AS_JSON, commands, done
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
