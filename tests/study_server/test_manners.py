"""Slow, clumsy and quitting raters, blocks by question and instructed items: the whole path before anyone is paid."""

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from study_fixture import write_study

from study_server.app import admin_secret
from study_server.manifest import load_study
from study_server.serve import served
from study_server.simulation.raters import Effects, Rater
from study_server.simulation.simulate import simulate

Rows = Callable[..., list[dict[str, str]]]


def simulated(study: Path, effects: Effects, csv_rows: Rows, table: str = "ratings") -> list[dict[str, str]]:
    """The export after six raters, five of whom stay."""
    with served(study, mode="simulated") as url:
        result = simulate(
            url, load_study(study), admin_secret(study), started=6, completed=5, effects=effects, progress=False
        )
        assert (result["completed"], result["lost"], result["duplicated"]) == (5, 0, 0)
        return csv_rows(study, url, table)


def test_manners_change_no_answer(tmp_path: Path, csv_rows: Rows) -> None:
    answers, revised = [], []
    for name, share in (("careful", 0.0), ("clumsy", 1.0)):
        effects = Effects(slow=share, clumsy=share)
        rows = simulated(write_study(tmp_path / name), effects, csv_rows)
        answers.append(Counter((row["stimulus"], row["question"], row["rating"]) for row in rows))
        revised.append(sum(row["revision"] == "1" for row in rows))
    assert answers[0] == answers[1]
    assert revised[0] == 0 < revised[1]


def test_slow_raters_take_three_times_as_long(tmp_path: Path, csv_rows: Rows) -> None:
    usual, slow = (
        sorted(
            float(row["rt_ms"])
            for row in simulated(write_study(tmp_path / str(share)), effects, csv_rows)
            if row["rt_ms"]
        )
        for share in (0.0, 1.0)
        for effects in [Effects(slow=share, clumsy=0)]
    )
    assert slow == pytest.approx([3 * ms for ms in usual], abs=0.2)


def test_shares_are_shares(tmp_path: Path) -> None:
    study = load_study(write_study(tmp_path))
    raters = [Rater(study, Effects(slow=0.3, clumsy=0.1), 5, number) for number in range(600)]
    assert 0.25 < sum(rater.is_slow for rater in raters) / 600 < 0.35
    assert 0.06 < sum(rater.is_clumsy for rater in raters) / 600 < 0.14


def test_blocks_by_question_are_walked_through(tmp_path: Path, csv_rows: Rows) -> None:
    rows = simulated(write_study(tmp_path, survey={"blocks": "by-question"}), Effects(), csv_rows)
    finished = [session for session, n in Counter(row["session"] for row in rows if row["rating"]).items() if n == 6]
    assert len(finished) == 5
    for session in finished:
        mine = [row for row in rows if row["session"] == session]
        assert [row["trial"] for row in mine] == ["1", "2", "3", "4", "5", "6"]
        first, second = {row["question"] for row in mine[:3]}, {row["question"] for row in mine[3:]}
        assert {*first, *second} == {"translucent", "realistic"}
        assert len(first) == len(second) == 1


@pytest.mark.parametrize(("clumsy", "fails"), [(0.0, False), (1.0, True)])
def test_instructed_items_are_obeyed_or_overlooked(tmp_path: Path, csv_rows: Rows, clumsy: float, fails: bool) -> None:
    study = write_study(
        tmp_path, 9, survey={"checks": 4, "completion_code": "GOOD", "prolific": {"failed_checks": "BAD"}}
    )
    rows = simulated(study, Effects(clumsy=clumsy), csv_rows)
    checks = [row for row in rows if row["check_expected"]]
    assert {row["question"] for row in checks} == {"check"}
    assert len(checks) == 6 * 4
    for row in checks:
        assert row["check_passed"] == ("" if not row["rating"] else str(int(row["rating"] == row["check_expected"])))
    assert ("0" in {row["check_passed"] for row in checks}) is fails
