"""Commands about ratings: report."""

from pathlib import Path
from typing import Any

import click
from tqdm import tqdm

from fakesss.cli import AS_JSON, STUDY, Mode, commands, done, say


@commands.command()
@STUDY
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Folder of the report (default: STUDY/report).")
@click.option("--ratings", type=click.Path(path_type=Path), help="A CSV from elsewhere instead of STUDY's ratings.")
@click.option("--database", metavar="URL", help="Where the ratings are (default: STUDY/ratings.sqlite).")
@AS_JSON
def report(study: Path, out: Path | None, ratings: Path | None, database: str | None, as_json: bool) -> None:
    """Analyse the ratings of STUDY: report/index.html, tables, figures, results.json.

    Live ratings where there are any, otherwise simulated ones, otherwise a pilot's; the report says which.

    Example: fakesss report my-study
    """
    from study_server.export import mode_to_analyse
    from study_server.manifest import load_study, study_changed

    if study_changed(load_study(study)):
        say(f"{study / 'study.toml'}: has changed since the pictures were built; the report is on the study as built")
    out = out or study / "report"
    if ratings is None:
        results = report_study(study, out, database, mode_to_analyse(study, database))
    else:
        results = write(ratings, out, study, participants=None)
    for warning in results["warnings"]:
        say(warning)
    done(results, as_json, str(out / "index.html"))


def report_study(study: Path, out: Path, database: str | None, mode: Mode) -> dict[str, Any]:
    """The report on the study's own ratings; what was analysed lies beside it in `data/`."""
    from study_server.export import export_ratings

    files = {p.stem: p for p in export_ratings(study, out / "data", mode=mode, database_url=database)}
    return write(files["ratings"], out, study, files["participants"])


def report_folder(study: Path, database: str | None, mode: Mode) -> Path:
    """The report as the admin page shows it, written now; a pilot's lies apart."""
    out = study / "report" if mode == "live" else study / "report" / mode
    report_study(study, out, database, mode)
    return out


def write(ratings: Path, out: Path, study: Path, participants: Path | None) -> dict[str, Any]:
    """The report on a CSV file of ratings of the study's pictures."""
    from analysis.report import write_report
    from stimuli.manifest import manifest_path

    with tqdm(desc="analyses", unit="analysis", disable=None) as bar:

        def tell(done: int, total: int, what: str) -> None:
            bar.total, bar.n = total, done
            bar.set_postfix_str(what)

        return write_report(ratings, out, manifest=manifest_path(study), participants=participants, progress=tell)
