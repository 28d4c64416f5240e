"""Commands about the answers of a study: backup, forget."""

from pathlib import Path

import click

from fakesss.cli import AS_JSON, STUDY, commands, done
from fakesss.problem import BadInput

DATABASE = click.option("--database", metavar="URL", help="Where the ratings are (default: STUDY/ratings.sqlite).")


@commands.command()
@STUDY
@click.option("-o", "--out", type=click.Path(path_type=Path), help="The file (default: STUDY/ratings-TIME.sqlite).")
@DATABASE
@AS_JSON
def backup(study: Path, out: Path | None, database: str | None, as_json: bool) -> None:
    """Copy the database of STUDY, whole and checked, while people go on rating.

    The copy holds the admin secret and the participants' addresses, as the original does. To go back to it, stop the
    server and put it in the place of ratings.sqlite. Never replaces a file.

    Example: fakesss backup my-study -o monday.sqlite
    """
    from study_server.storage.backup import backup as copy

    result = copy(study, out, database)
    done(result, as_json, f"{result['file']}\n{result['bytes']} bytes, checked; holds the admin secret: keep it safe")


@commands.command()
@STUDY
@DATABASE
@click.option("--yes", is_flag=True, help="Do not ask.")
@AS_JSON
def forget(study: Path, database: str | None, yes: bool, as_json: bool) -> None:
    """Delete for good what could name the participants of STUDY; their ratings stay.

    Names given by a recruiting service, completion codes, comments, answers in free text, network addresses and browser
    names, the participants' addresses, and the salt of their pseudonyms; and STUDY/report, which holds them too and can
    be written anew. The study is closed. Make the export first: afterwards sessions of one person cannot be told to be
    of one. Exports and backups made earlier are left to you. A running server is to be started anew.

    Example: fakesss forget my-study
    """
    from study_server.storage.forget import forget as forget_people
    from study_server.storage.forget import sessions_held

    if not yes:
        people = sessions_held(study, database)
        question = f"{people} sessions: delete what could name people, and STUDY/report, for good?"
        if not click.confirm(question, err=True):
            raise BadInput(f"{study}: nothing was deleted, as you said")
    result = forget_people(study, database)
    told = [f"{result['sessions']} sessions name nobody any more; {result['ratings_kept']} ratings are kept"]
    if result["report_deleted"]:
        told.append(f"{result['report_deleted']} was deleted; fakesss report {study} writes it anew")
    left = ", ".join(result["exports_left"]) or "none in the study's folder"
    told.append(f"earlier exports ({left}) and backups are as they were: see to them too")
    done(result, as_json, "\n".join(told))
