"""How many people the survey serves at once, and how near its saves come to bare SQLite.

Two questions, each answered with all acknowledged answers looked up in the export afterwards.

Throughput: people without think time, the next save sent when the last is acknowledged. In turn with it, in the same
rounds, on the same disk: bare SQLite in plain sqlite3 (WAL, synchronous=FULL, a transaction each), once a single
INSERT, once the very statements that the survey sends for a save, recorded from it. The disk is also made as slow as
others are: a library loaded before sqlite's (LD_PRELOAD) adds the stated time to every fsync and fdatasync.

People: with think time as people have it (lognormal), fetching each picture once, more and more of them until the
99th percentile of a save passes 50 ms.

Server, people and bare SQLite are processes of their own; how busy the people's process was is told with each figure.
"""

import csv
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
from sqlalchemy import event
from survey_disk import Transaction, is_save, machine, slow_disk
from survey_study import write_study

from study_server.app import create_app
from study_server.exports.export import export_ratings
from study_server.serve import running
from study_server.storage.engines import sqlite_url

HERE = Path(__file__).parent
SERVER = """
import sys
from pathlib import Path
from study_server.serve import serve
serve(Path(sys.argv[1]), port=0, database_url=sys.argv[2], workers=int(sys.argv[3]))
"""
MANY, USUAL = 200, 40
"""Pictures of the study for throughput, so that nobody is through too soon, and of the study with think time."""
SIGMA = 0.5
"""Spread of the logarithm of think time."""
GOAL_MS = 50.0


@contextmanager
def server(study: Path, database: str, workers: int = 1, **environment: str) -> Iterator[str]:
    """The survey as `fakesss serve` runs it: its address."""
    command = [sys.executable, "-c", SERVER, str(study), database, str(workers)]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env={**os.environ, **environment})
    assert process.stderr is not None
    try:
        for line in process.stderr:
            if "participants" in line:
                yield line.split()[1].rstrip("/")
                break
        else:
            raise click.ClickException("the server did not start")
    finally:
        process.terminate()
        process.communicate()


def crowd(url: str, **order: Any) -> Iterator[dict[str, Any]]:
    """What the people's process says, line by line."""
    told = {"url": url, "median_s": 0.0, "sigma": SIGMA, "fetches": False, "at_the_door": 4, "settle_s": 0.5,
            "until_p99_ms": math.inf, **order}  # fmt: skip
    command = [sys.executable, str(HERE / "survey_people.py")]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None and process.stdout is not None
        process.stdin.write(json.dumps(told) + "\n")
        process.stdin.close()
        for line in process.stdout:
            yield json.loads(line)
    if process.returncode:
        raise click.ClickException("the simulated people gave up")


def recorded(study: Path, folder: Path) -> tuple[Path, list[Transaction]]:
    """A fresh database, and all that one person's way through the survey writes to it, transaction by transaction."""
    app = create_app(study, database_url=sqlite_url(folder / "recorded.sqlite"))
    database = app.state.site.database
    fresh = folder / "fresh.sqlite"
    with database.reading() as connection:
        connection.exec_driver_sql("COMMIT")  # VACUUM works outside of transactions only
        connection.exec_driver_sql(f"VACUUM INTO '{fresh}'")
        connection.exec_driver_sql("BEGIN")
    transactions: list[Transaction] = []
    under_way: dict[int, Transaction] = {}

    def note(connection: Any, _cursor: Any, sql: str, values: Any, _context: Any, many: bool) -> None:
        if not sql.startswith(("SAVEPOINT", "RELEASE", "BEGIN")):
            rows = values if many else [values]
            under_way.setdefault(id(connection), []).extend((sql, list(row)) for row in rows)

    event.listen(database.engine, "before_cursor_execute", note)
    event.listen(database.engine, "rollback", lambda connection: under_way.pop(id(connection), None))
    event.listen(database.engine, "commit", lambda connection: transactions.append(under_way.pop(id(connection), [])))
    with running(app) as url:
        list(crowd(url, people=[1], seconds=2.0))
    return fresh, transactions


def bare(kind: str, path: Path, seconds: float, environment: dict[str, str], saves: list[Any]) -> float:
    """Transactions/s of bare SQLite."""
    command = [sys.executable, str(HERE / "survey_disk.py"), kind, str(path), str(seconds)]
    done = subprocess.run(command, input=json.dumps(saves), capture_output=True, text=True, check=True,
                          env={**os.environ, **environment})  # fmt: skip
    return float(done.stdout)


def checked(study: Path, database: str, acknowledged: list[list[Any]], folder: Path) -> dict[str, int]:
    """What became of every acknowledged answer, by the export."""
    files = export_ratings(study, folder / "export", mode="simulated", database_url=database)
    with next(path for path in files if path.name == "ratings.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["rating"]]
    stored = {(row["session"], row["trial"], row["question"]): row["rating"] for row in rows}
    times = Counter((row["session"], row["trial"], row["question"]) for row in rows)
    lost = sum(
        stored.get((session, trial, question)) != str(rating) for session, trial, question, rating in acknowledged
    )
    return {"acknowledged": len(acknowledged), "lost": lost, "duplicated": sum(n - 1 for n in times.values())}


@dataclass
class Row:
    """One way to serve: what is measured of it."""

    name: str
    database: str
    disk_ms: float = 0.0
    workers: int = 1
    bare: bool = True


def throughput(row: Row, study: Path, folder: Path, saves: tuple[Path, list[Transaction]], people: int, rounds: int,
               seconds: float) -> dict[str, Any]:  # fmt: skip
    """Medians over rounds, in each of which everything compared has its turn."""
    fresh, transactions = saves
    environment = slow_disk(folder, row.disk_ms)
    measured: dict[str, list[float]] = {}
    acknowledged: list[list[Any]] = []
    with server(study, row.database, row.workers, **environment) as url:
        for _ in range(rounds):
            told: dict[str, float] = {}
            if row.bare:
                told["inserts_per_s"] = bare("insert", folder / "insert.sqlite", seconds / 2, environment, [])
                told["statements_per_s"] = bare("saves", fresh, seconds / 2, environment, transactions)
            for line in crowd(url, people=[people], seconds=seconds):
                if "acknowledged" in line:
                    acknowledged += line["acknowledged"]
                else:
                    told |= line
            if row.bare:
                told["of_inserts"] = told["saves_per_s"] / told["inserts_per_s"]
                told["of_statements"] = told["saves_per_s"] / told["statements_per_s"]
            for name, value in told.items():
                measured.setdefault(name, []).append(value)
    return {
        "name": row.name,
        **{name: statistics.median(values) for name, values in measured.items()},
        **checked(study, row.database, acknowledged, folder),
    }


def people_at_once(row: Row, study: Path, folder: Path, sizes: list[int], median_s: float, seconds: float
                   ) -> list[dict[str, Any]]:  # fmt: skip
    """A growing crowd with think time, until a save's 99th percentile passes the goal."""
    results: list[dict[str, Any]] = []
    with server(study, row.database, row.workers) as url:
        order = {"people": sizes, "seconds": seconds, "median_s": median_s, "fetches": True, "settle_s": 2.0}
        for told in crowd(url, until_p99_ms=GOAL_MS, **order):
            if "acknowledged" in told:
                acknowledged = told["acknowledged"]
            else:
                results.append({"name": row.name, **told})
    return [{**result, **checked(study, row.database, acknowledged, folder)} for result in results]


def print_table(rows: list[dict[str, Any]], columns: dict[str, str]) -> None:
    """Markdown; `columns`: heading -> format of the value of that name."""
    click.echo("\n| | " + " | ".join(name.replace("_", " ") for name in columns) + " |")
    click.echo("|---|" + "---:|" * len(columns))
    for row in rows:
        cells = [format(row[name], shape) if name in row else "" for name, shape in columns.items()]
        click.echo(f"| {row['name']} | " + " | ".join(cells) + " |")


THROUGHPUT = {"saves_per_s": ",.0f", "inserts_per_s": ",.0f", "statements_per_s": ",.0f", "of_inserts": ".0%",
              "of_statements": ".0%", "p50_ms": ".1f", "p99_ms": ".1f", "people_cpu": ".0%", "acknowledged": ",d",
              "lost": "d", "duplicated": "d"}  # fmt: skip
PEOPLE = {"people": ",d", "saves_per_s": ",.0f", "p50_ms": ".1f", "p99_ms": ".1f", "max_ms": ".0f", "people_cpu": ".0%",
          "acknowledged": ",d", "lost": "d", "duplicated": "d"}  # fmt: skip


@click.command(help=__doc__)
@click.option("--folder", type=click.Path(path_type=Path), help="On the disk to be measured [default: temporary].")
@click.option("--people", default=64, show_default=True, help="Without think time.")
@click.option("--rounds", default=3, show_default=True)
@click.option("--seconds", default=4.0, show_default=True, help="Of each measurement.")
@click.option("--think", default=4.0, show_default=True, help="Median think time per picture, seconds.")
@click.option("--slow", default="2,8", show_default=True, help="Emulated disks: ms that each sync takes longer.")
@click.option("--postgres/--no-postgres", default=True, show_default=True, help="The tests' own server.")
@click.option("--out", type=click.Path(path_type=Path), help="JSON of all figures.")
def main(folder: Path | None, people: int, rounds: int, seconds: float, think: float, slow: str, postgres: bool,
         out: Path | None) -> None:  # fmt: skip
    """Measure, print tables, write JSON."""
    with ExitStack() as stack:
        folder = folder or Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="survey-load-", dir=Path.cwd())))
        many, usual = write_study(folder / "many", MANY), write_study(folder / "usual", USUAL)
        saves = recorded(many, folder)
        report: dict[str, Any] = {"machine": machine(folder), "statements": [sql for sql, _ in last_save(saves[1])]}
        rows = [Row("SQLite", sqlite_url(folder / "0.sqlite"))]
        rows += [
            Row(f"SQLite, disk +{ms} ms", sqlite_url(folder / f"{ms}.sqlite"), float(ms))
            for ms in slow.split(",")
            if ms
        ]
        postgres_rows = rows_on_postgres(stack) if postgres else []
        report["throughput"] = [
            throughput(row, many, folder, saves, people, rounds, seconds) for row in [*rows, *postgres_rows]
        ]
        print_table(report["throughput"], THROUGHPUT)
        most = report["throughput"][0]["saves_per_s"] * think * math.exp(SIGMA**2 / 2)
        sizes = [round(most * share / 20) for share in range(1, 21)]
        report["people"] = people_at_once(
            Row("SQLite", sqlite_url(folder / "usual.sqlite")), usual, folder, sizes, think, 3 * seconds
        )
        print_table(report["people"], PEOPLE)
        click.echo(f"\n{limit_words(report['people'])}")
        click.echo(f"\n{json.dumps(report['machine'])}; a save is {len(report['statements'])} statements")
    if out:
        out.write_text(json.dumps(report, indent=1))


def limit_words(results: list[dict[str, Any]]) -> str:
    """Between which crowds the 99th percentile of a save passed the goal."""
    kept = [result["people"] for result in results if result["p99_ms"] <= GOAL_MS]
    passed = [result["people"] for result in results if result["p99_ms"] > GOAL_MS]
    if not passed:
        return f"The 99th percentile of a save stays below {GOAL_MS:.0f} ms up to {kept[-1]} people."
    before = kept[-1] if kept else 0
    return f"The 99th percentile of a save passes {GOAL_MS:.0f} ms between {before} and {passed[0]} people."


def last_save(transactions: list[Transaction]) -> Transaction:
    """The statements of one save."""
    return next(statements for statements in reversed(transactions) if is_save(statements))


def rows_on_postgres(stack: ExitStack) -> list[Row]:
    """One and two workers, each on an empty database of the server that the tests use."""
    sys.path.insert(0, str(HERE.parent / "tests"))
    from postgres_server import postgres_server

    server = stack.enter_context(postgres_server())
    return [
        Row(f"PostgreSQL, {workers} worker{'s' * (workers > 1)}", stack.enter_context(server.new_database()),
            workers=workers, bare=False)
        for workers in (1, 2)
    ]  # fmt: skip


if __name__ == "__main__":
    main()
