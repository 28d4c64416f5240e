"""Commands about a study: new, build, verify, serve, run, simulate, export."""

import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import click

from fakesss.cli import AS_JSON, STUDY, Mode, commands, done, say


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
    from stimuli.build import build, levels_without_effect
    from stimuli.design import stimuli_of
    from stimuli.study import Study, study_file
    from study_server.manifest import check_number_of_checks
    from study_server.settings import check_survey

    path = study_file(study)
    table = read_toml(path)
    asked = check_survey(table, path.name)
    shown = [stimulus.id for stimulus in stimuli_of(Study.load(study))]
    check_number_of_checks(asked, len(shown), path.name)
    check_analysis(table, path.name, shown)
    manifest = build(study, jobs=jobs, force=force)
    told = [f"{e['id']}: {text}" for e in manifest["stimuli"] for text in e["warnings"]]
    for warning in [*dict.fromkeys(told), *levels_without_effect(manifest)]:
        say(warning)
    return manifest


def distinct(manifest: Mapping[str, Any]) -> set[str]:
    """Hashes of the pictures, each once."""
    return {entry["sha256"] for entry in manifest["stimuli"]}


@commands.command()
@STUDY
@click.option("--offline", is_flag=True, help="Path-trace again too what is neither shipped nor kept: minutes each.")
@AS_JSON
def verify(study: Path, offline: bool, as_json: bool) -> None:
    """Draw every picture of STUDY again in memory and compare its bytes with the manifest.

    Example: fakesss verify my-study
    """
    from stimuli.build import verify as compare

    problems = compare(study, offline=offline)
    done({"equal": not problems, "problems": problems}, as_json, "\n".join(problems) or "every picture is the same")
    sys.exit(1 if problems else 0)


def serving(command: Callable[..., None]) -> Callable[..., None]:
    """The options of `serve` and `run`."""
    for option in (
        click.option("--host", default="127.0.0.1", show_default=True, help="Address to listen on."),
        click.option("--port", default=8000, show_default=True, type=click.IntRange(0, 65535), help="0: any free."),
        click.option("--database", metavar="URL", help="Where ratings go (default: STUDY/ratings.sqlite)."),
        click.option("--pilot", is_flag=True, help="A try-out: kept apart from live answers everywhere."),
        click.option("--workers", default=1, show_default=True, type=click.IntRange(1), help="Processes (PostgreSQL)."),
        click.option("--proxy", metavar="ADDRESS[,...]", default="", help="Believe X-Forwarded-* from there only."),
    ):
        command = option(command)
    return command


@commands.command()
@STUDY
@serving
def serve(study: Path, **options: Any) -> None:
    """Show the survey of STUDY to browsers and record their ratings.

    Example: fakesss serve my-study --port 8080
    """
    serve_study(study, **options)


@commands.command()
@STUDY
@serving
def run(study: Path, **options: Any) -> None:
    """Build STUDY, then serve it.

    Example: fakesss run my-study
    """
    build_study(study)
    serve_study(study, **options)


def serve_study(study: Path, host: str, port: int, database: str | None, pilot: bool, workers: int, proxy: str) -> None:
    """The survey with the report behind /admin/report, until interrupted."""
    from analysis.script import script_source
    from fakesss.cli_analysis import report_folder
    from study_server.serve import serve as serve_until_interrupted

    mode: Mode = "pilot" if pilot else "live"
    make_report = partial(report_folder, study, database, mode)
    serve_until_interrupted(
        study,
        host,
        port,
        database_url=database,
        mode=mode,
        make_report=make_report,
        report_script=script_source(),
        workers=workers,
        proxies=[address.strip() for address in proxy.split(",") if address.strip()],
    )


@commands.command()
@STUDY
@click.option("--url", help="A survey that runs already, in any mode; without it one is started and stopped again.")
@click.option("--started", default=44, show_default=True, type=click.IntRange(1), help="Raters who begin.")
@click.option("--completed", type=click.IntRange(0), help="Raters who finish (default: 38 of 44, in proportion).")
@click.option("--seed", default=2011, show_default=True, type=click.IntRange(0), help="All that is random follows.")
@click.option("--database", metavar="URL", help="Where ratings go (default: STUDY/ratings.sqlite).")
@click.option("--effects", type=click.Path(path_type=Path), help="TOML file of the raters' effects (docs/survey.md).")
@AS_JSON
def simulate(
    study: Path,
    url: str | None,
    started: int,
    completed: int | None,
    seed: int,
    database: str | None,
    effects: Path | None,
    as_json: bool,
) -> None:
    """Let simulated raters answer STUDY over HTTP. Their answers are marked as simulated.

    Example: fakesss simulate my-study --started 44 --completed 38
    """
    from study_server.app import admin_secret
    from study_server.manifest import load_study
    from study_server.serve import served
    from study_server.simulation.simulate import simulate as walk

    built = load_study(study)
    raters = partial(walk, started=started, completed=completed, seed=seed, effects=effects)
    if url is None:
        with served(study, database_url=database, mode="simulated") as own:
            result = raters(own, built, admin_secret(study, database))
    else:
        result = raters(url, built, admin_secret(study, database))
    text = "\n".join(f"{name:13} {value}" for name, value in result.items())
    done(result, as_json, text)
    sys.exit(1 if result["lost"] or result["duplicated"] else 0)


@commands.command()
@STUDY
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Folder (default: STUDY/export, STUDY/psych-ds).")
@click.option("--format", "form", type=click.Choice(["csv", "psych-ds"]), default="csv", show_default=True)
@click.option("--database", metavar="URL", help="Where the ratings are (default: STUDY/ratings.sqlite).")
@click.option("--mode", type=click.Choice(["live", "pilot", "simulated"]), default="live", show_default=True)
@AS_JSON
def export(study: Path, out: Path | None, form: str, database: str | None, mode: Mode, as_json: bool) -> None:
    """Write ratings, participants, events, stimuli and a codebook of STUDY: CSV files, or a Psych-DS dataset.

    Example: fakesss export my-study --format psych-ds -o dataset
    """
    from study_server.exports.export import export_ratings, left_out
    from study_server.exports.psych_ds import export_psych_ds

    write, usual = (export_ratings, "export") if form == "csv" else (export_psych_ds, "psych-ds")
    files = [str(path) for path in write(study, out or study / usual, mode=mode, database_url=database)]
    for sentence in left_out(study, mode, database):
        say(sentence)
    done({"files": files}, as_json, "\n".join(files))
