"""Commands about ratings: report."""

import shlex
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import click
from tqdm import tqdm

from fakesss.cli import AS_JSON, Mode, commands, done, say
from fakesss.problem import BadInput

PATH = click.Path(path_type=Path)
FROM_ELSEWHERE = ("columns", "wide", "factors", "scale", "participants")  # say how a CSV is read


@commands.command()
@click.argument("study", type=PATH, required=False)
@click.option("-o", "--out", type=PATH, help="Folder of the report (default: STUDY/report, without STUDY report).")
@click.option("--ratings", type=PATH, help="A CSV from elsewhere; STUDY may then be left out.")
@click.option(
    "--column", "columns", multiple=True, metavar="OURS=THEIRS", help="As in stimulus=photo; may be repeated."
)
@click.option("--wide", metavar="FORM", help='Columns that hold a picture each: "img*" or "{stimulus}_{question}".')
@click.option(
    "--factor", "factors", multiple=True, metavar="NAME[=COLUMN]", help="A column of levels; may be repeated."
)
@click.option("--scale", metavar="N", help='Highest answer in the CSV, 7 if not given; "none": any number.')
@click.option("--analysis", "plan", type=PATH, help="TOML file with the table [analysis], instead of STUDY's.")
@click.option("--participants", type=PATH, help="CSV of everyone who started.")
@click.option("--database", metavar="URL", help="Where the ratings are (default: STUDY/ratings.sqlite).")
@click.option("--pdf", is_flag=True, help="Print the page too, report.pdf beside it (needs Chromium or Chrome).")
@AS_JSON
def report(study: Path | None, out: Path | None, database: str | None, pdf: bool, as_json: bool, **given: Any) -> None:
    """Analyse the ratings of STUDY: report/index.html, tables, figures, results.json.

    Live ratings where there are any, otherwise simulated ones, otherwise a pilot's; the report says which. With
    --ratings, a CSV from anywhere: one row per rating, or --wide.

    Example: fakesss report my-study

    Example: fakesss report --ratings my.csv --column stimulus=photo --column rating=stars --factor light=lamp
    """
    refuse_halves(study, given)
    if study is not None:
        say_changed(study)
    out = out or (study or Path()) / "report"
    print_pdf = pdf_printer(out) if pdf else None
    options = {"plan": plan_in(given["plan"]), "command": spoken(study, given)}
    if study is not None and given["ratings"] is None:
        from study_server.exports.export import left_out, mode_to_analyse

        mode = mode_to_analyse(study, database)
        results = report_study(study, out, database, mode, **options)
        for sentence in left_out(study, mode, database):
            say(sentence)
    else:
        reading = {
            "columns": all_halves(given["columns"], "column"),
            "factors": all_halves(given["factors"], "factor"),
            "wide": given["wide"],
            "participants": given["participants"],
            **scale_in(given["scale"]),
        }
        results = write(given["ratings"], out, study, **reading, **options)
    for warning in results["warnings"]:
        say(warning)
    pages = [str(out / "index.html"), *([str(print_pdf())] if print_pdf else [])]
    done(results, as_json, "\n".join(pages))


def pdf_printer(out: Path) -> Callable[[], Path]:
    """What prints the report in `out`; a browser is looked for now, before an analysis that may take long."""
    from analysis.pdf import write_pdf
    from fakesss.browser import find_browser

    find_browser()
    return lambda: write_pdf(out / "index.html", out / "report.pdf")


def refuse_halves(study: Path | None, given: Mapping[str, Any]) -> None:
    """Options that mean something only together."""
    if study is None and given["ratings"] is None:
        raise BadInput("report: nothing to analyse; name a STUDY, or a CSV with --ratings my.csv")
    if given["ratings"] is None and (alone := next((name for name in FROM_ELSEWHERE if given[name]), None)):
        raise BadInput(
            f"--{alone.removesuffix('s') if alone != 'participants' else alone}: says how a CSV is read; "
            "name it with --ratings my.csv"
        )
    if study is not None and given["scale"]:
        raise BadInput("--scale: the study says each question's scale; leave --scale out, or STUDY")


def say_changed(study: Path) -> None:
    """A study.toml edited after the build describes other pictures than were rated."""
    from study_server.manifest import load_study, study_changed

    if study_changed(load_study(study)):
        say(f"{study / 'study.toml'}: has changed since the pictures were built; the report is on the study as built")


def plan_in(path: Path | None) -> Any:
    """The plan in a file of its own; None leaves the study's."""
    from analysis.plan import read_plan

    return None if path is None else read_plan(path)


def all_halves(texts: Sequence[str], option: str) -> dict[str, str]:
    """Name -> column of an option that may be repeated, each name once."""
    found: dict[str, str] = {}
    for name, column in (halves(text, option) for text in texts):
        if name in found:
            raise BadInput(f"--{option} {name}: is given twice, as {found[name]} and as {column}; leave one out")
        found[name] = column
    return found


def halves(text: str, option: str) -> tuple[str, str]:
    """NAME=COLUMN; a factor's column may have the factor's name."""
    name, equals, column = text.partition("=")
    if not name or (equals and not column) or (option == "column" and not equals):
        raise BadInput(f'--{option} "{text}": must be {"OURS=THEIRS" if option == "column" else "NAME=COLUMN"}')
    return name, column or name


def scale_in(text: str | None) -> dict[str, int | None]:
    """The `scale` of `write_report`; nothing where none was named."""
    if text is None:
        return {}
    if text == "none":
        return {"scale": None}
    from analysis.ratings import refuse_scale

    scale = int(text) if text.isdecimal() and len(text) < 10 else 0
    refuse_scale(scale, f'--scale "{text}"')
    return {"scale": scale}


def spoken(study: Path | None, given: Mapping[str, Any]) -> str:
    """The command for the session block: what decides the numbers, files by their names alone."""
    words = ["fakesss", "report", *([study.resolve().name] if study is not None else [])]
    names = {"columns": "column", "factors": "factor", "plan": "analysis"}
    for option, value in given.items():
        for each in value if isinstance(value, tuple) else (value,) if value is not None else ():
            words += [f"--{names.get(option, option)}", each.name if isinstance(each, Path) else each]
    return shlex.join(words)


def report_study(study: Path, out: Path, database: str | None, mode: Mode, **options: Any) -> dict[str, Any]:
    """The report on the study's own ratings; what was analysed lies beside it in `data/`."""
    from study_server.exports.export import export_ratings

    files = {p.stem: p for p in export_ratings(study, out / "data", mode=mode, database_url=database)}
    return write(files["ratings"], out, study, participants=files["participants"], **options)


def report_folder(study: Path, database: str | None, mode: Mode) -> Path:
    """The report as the admin page shows it, written now; a pilot's lies apart."""
    out = study / "report" if mode == "live" else study / "report" / mode
    report_study(study, out, database, mode, command=f"fakesss report {shlex.quote(study.resolve().name)}")
    return out


def write(ratings: Path, out: Path, study: Path | None, **options: Any) -> dict[str, Any]:
    """The report on a CSV file of ratings, of the study's pictures where there is a study."""
    from analysis.report import write_report
    from stimuli.manifest import manifest_path

    with tqdm(desc="analyses", unit="analysis", disable=None) as bar:

        def tell(done: int, total: int, what: str) -> None:
            bar.total, bar.n = total, done
            bar.set_postfix_str(what)

        manifest = None if study is None else manifest_path(study)
        return write_report(ratings, out, manifest=manifest, progress=tell, **options)
