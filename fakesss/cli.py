"""The `fakesss` command: composes the four packages. Each command imports what it needs when it runs."""

import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import click

from fakesss import __version__
from fakesss.problem import BadInput

STUDY = click.argument("study", type=click.Path(path_type=Path))
AS_JSON = click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="fakesss")
def commands() -> None:
    """Perceptual translucency studies: pictures, survey and statistics in one folder.

    Example: fakesss new my-study && fakesss run my-study
    """


def main() -> None:
    """Runs the command; bad input is one sentence on standard error and exit code 2."""
    try:
        sys.exit(commands(standalone_mode=False) or 0)
    except BadInput as error:
        print(f"fakesss: {error}", file=sys.stderr)
        sys.exit(2)
    except click.ClickException as error:
        error.show()
        sys.exit(2)
    except (KeyboardInterrupt, click.Abort):
        print("fakesss: stopped; what was done is kept, the same command continues", file=sys.stderr)
        sys.exit(130)


def say(text: str) -> None:
    """A message for people; standard output is kept for `--json` documents."""
    print(text, file=sys.stderr)


def done(result: Mapping[str, Any], as_json: bool, text: str) -> None:
    """The command's outcome, as JSON on standard output or as text."""
    print(json.dumps(result, indent=1, ensure_ascii=False) if as_json else text)


@commands.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--template", default="thesis", show_default=True, help="thesis, minimal or factorial.")
@AS_JSON
def new(folder: Path, template: str, as_json: bool) -> None:
    """Write a commented study.toml into FOLDER.

    Example: fakesss new my-study --template factorial
    """
    from stimuli.template import write_template

    path = write_template(folder, template)
    done({"study": str(path)}, as_json, f"{path}\nnext: fakesss run {folder}")


@commands.command()
@STUDY
@click.option("--jobs", default=1, show_default=True, type=click.IntRange(1), help="Processes that draw.")
@click.option("--force", is_flag=True, help="Draw even what is up to date.")
@AS_JSON
def build(study: Path, jobs: int, force: bool, as_json: bool) -> None:
    """Draw the pictures of STUDY that are missing or stale, and write its manifest.

    Example: fakesss build my-study --jobs 2
    """
    manifest = build_study(study, jobs, force)
    count = len(manifest["stimuli"])
    done(manifest, as_json, f"{study / 'stimuli'}: {count} pictures, {len(distinct(manifest))} distinct")


def build_study(study: Path, jobs: int = 1, force: bool = False) -> dict[str, Any]:
    """All of study.toml checked, each table by its owner, before the first picture is drawn."""
    from analysis.plan import check_analysis
    from fakesss.scene import read_toml
    from stimuli.build import build
    from stimuli.study import study_file
    from study_server.settings import check_survey

    path = study_file(study)
    table = read_toml(path)
    check_survey(table, path.name)
    check_analysis(table, path.name)
    manifest = build(study, jobs=jobs, force=force)
    for warning in dict.fromkeys(f"{e['id']}: {text}" for e in manifest["stimuli"] for text in e["warnings"]):
        say(warning)
    return manifest


def distinct(manifest: Mapping[str, Any]) -> set[str]:
    """Hashes of the pictures, each once."""
    return {entry["sha256"] for entry in manifest["stimuli"]}


@commands.command()
@STUDY
@AS_JSON
def verify(study: Path, as_json: bool) -> None:
    """Draw every picture of STUDY again in memory and compare its bytes with the manifest.

    Example: fakesss verify my-study
    """
    from stimuli.build import verify as compare

    problems = compare(study)
    done({"equal": not problems, "problems": problems}, as_json, "\n".join(problems) or "every picture is the same")
    sys.exit(1 if problems else 0)


def serving(command: Callable[..., None]) -> Callable[..., None]:
    """The options of `serve` and `run`."""
    for option in (
        click.option("--host", default="127.0.0.1", show_default=True, help="Address to listen on."),
        click.option("--port", default=8000, show_default=True, type=click.IntRange(0, 65535), help="0: any free."),
        click.option("--database", metavar="URL", help="Where ratings go (default: STUDY/ratings.sqlite)."),
        click.option("--pilot", is_flag=True, help="A try-out: kept apart from live answers everywhere."),
    ):
        command = option(command)
    return command


@commands.command()
@STUDY
@serving
def serve(study: Path, host: str, port: int, database: str | None, pilot: bool) -> None:
    """Show the survey of STUDY to browsers and record their ratings.

    Example: fakesss serve my-study --port 8080
    """
    serve_study(study, host, port, database, pilot)


@commands.command()
@STUDY
@serving
def run(study: Path, host: str, port: int, database: str | None, pilot: bool) -> None:
    """Build STUDY, then serve it.

    Example: fakesss run my-study
    """
    build_study(study)
    serve_study(study, host, port, database, pilot)
