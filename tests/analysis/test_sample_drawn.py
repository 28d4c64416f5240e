"""Who is analysed, who is not and why."""

from collections.abc import Callable
from pathlib import Path

import pytest

from analysis.plan import AnalysisPlan
from analysis.ratings import read_ratings
from analysis.sample import Sample, draw_sample
from fakesss.problem import BadInput

HEAD = "participant,stimulus,question,rating,rt_ms,check_expected,check_passed\n"
ROWS = [
    "p1,a,q,2,900,,", "p1,b,q,5,800,,", "p1,c,q,6,800,,", "p1,a,q,3,500,3,1",
    "p2,a,q,4,90,,", "p2,b,q,4,80,,", "p2,c,q,4,95,,", "p2,a,q,5,100,3,0",
    "p10,a,q,1,700,,", "p10,b,q,,,,", "p10,c,q,7,700,,",
    "p3,a,q,3,700,,", "p3,b,q,2,700,,", "p3,c,q,7,700,,",
]  # fmt: skip


@pytest.fixture
def sample(csv_of: Callable[[str], Path]) -> Callable[..., Sample]:
    """The sample of the ratings above under a plan."""
    path = csv_of(HEAD + "\n".join(ROWS))

    def draw(participants: Path | None = None, **plan: object) -> Sample:
        return draw_sample(read_ratings(path), AnalysisPlan.model_validate(plan), participants)

    return draw


def test_completers_by_their_ratings(sample: Callable[..., Sample]) -> None:
    """p10 left an answer out."""
    drawn = sample()
    assert (drawn.n_started, drawn.n_completed, drawn.n_analysed, drawn.mode) == (4, 3, 3, "repeated")
    assert drawn.excluded == (("p10", "did not complete"),)
    assert len(drawn.ratings) == 9  # no attention checks among the ratings


def test_everybody(sample: Callable[..., Sample]) -> None:
    """completers_only = false keeps p10; the missing answer is counted."""
    drawn = sample(completers_only=False)
    assert (drawn.n_analysed, drawn.n_missing, drawn.excluded) == (4, 1, ())


@pytest.mark.parametrize(
    ("rule", "reason"),
    [
        ({"failed_checks": 1}, "failed 1 attention check"),
        ({"median_rt_ms_below": 300}, "median answer time 90 ms"),
        ({"same_answer_share": 0.75}, "gave one answer in 100% of the ratings"),
    ],
)
def test_declared_rules(sample: Callable[..., Sample], rule: dict[str, float], reason: str) -> None:
    """Each rule takes p2 out and says so."""
    assert sample(completers_only=False, exclude=rule).excluded == (("p2", reason),)


def test_participants_file(sample: Callable[..., Sample], tmp_path: Path) -> None:
    """People who started without rating count; who finished is as the survey says."""
    path = tmp_path / "participants.csv"
    path.write_text(
        "participant,mode,status,finished_at\np1,live,finished,2026-01-01T10:00:00Z\np2,live,finished,2026-01-01T11:00:00Z\n"
        "p3,live,dropped,\np10,live,dropped,\np11,live,dropped,\np12,pilot,finished,2026-01-01T11:00:00Z\n"
    )
    drawn = sample(path)
    assert (drawn.n_started, drawn.n_completed, drawn.n_analysed) == (5, 2, 2)
    assert [who for who, _ in drawn.excluded] == ["p3", "p10", "p11"]


def test_who_withdrew_has_not_completed(sample: Callable[..., Sample], tmp_path: Path) -> None:
    """Even after the last answer; who withdrew once and finished another time has completed."""
    path = tmp_path / "participants.csv"
    path.write_text(
        "participant,status,finished_at\np1,finished,2026-01-01T10:00:00Z\np2,withdrawn,2026-01-01T11:00:00Z\n"
        "p3,withdrawn,\np3,finished,2026-01-01T11:00:00Z\np10,dropped,\n"
    )
    drawn = sample(path)
    assert (drawn.n_started, drawn.n_completed, drawn.n_analysed) == (4, 2, 2)
    assert drawn.excluded == (("p2", "withdrew"), ("p10", "did not complete"))
    assert ("p2", "withdrew") in sample(path, completers_only=False).excluded


SESSIONS = "session,started_at,participant,stimulus,question,rating\n"


def visit(name: str, hour: int, who: str, answers: str) -> str:
    """A session's answers to pictures a, b, c; "-" is a missing one."""
    cells = zip("abc", answers, strict=False)
    return "".join(f"{name},2026-01-01T{hour:02}:00Z,{who},{what},q,{n.strip('-')}\n" for what, n in cells)


@pytest.mark.parametrize(
    ("first", "second", "kept", "left_out"),
    [("123", "765", [1, 2, 3], "s2"), ("12-", "765", [7, 6, 5], "s1"), ("1", "765", [7, 6, 5], "s1")],
)
def test_who_took_part_twice_counts_once(
    csv_of: Callable[[str], Path], first: str, second: str, kept: list[float], left_out: str
) -> None:
    """The first complete session counts, however the file is sorted."""
    visits = visit("s2", 12, "p1", second) + visit("s1", 9, "p1", first) + visit("s3", 10, "p2", "444")
    drawn = draw_sample(read_ratings(csv_of(SESSIONS + visits)), AnalysisPlan())
    assert drawn.set_aside == (("p1", left_out),)
    assert drawn.ratings.loc[drawn.ratings["participant"] == "p1", "rating"].tolist() == kept
    assert (drawn.n_started, drawn.n_completed, len(drawn.everything)) == (2, 2, 6)


def test_sessions_that_share_no_picture_belong_together(csv_of: Callable[[str], Path]) -> None:
    """A study split over two days."""
    rows = "s1,,p1,a,q,1\ns2,,p1,b,q,2\ns3,,p2,a,q,5\ns4,,p2,b,q,7\n"
    drawn = draw_sample(read_ratings(csv_of(SESSIONS + rows)), AnalysisPlan())
    assert (drawn.set_aside, len(drawn.ratings)) == ((), 4)


def test_two_answers_within_one_session_are_refused(csv_of: Callable[[str], Path]) -> None:
    """A second session is a visit; a second answer in it is a mistake."""
    with pytest.raises(BadInput, match='line 5: participant "p1" rated "a" on "q" twice'):
        read_ratings(csv_of(SESSIONS + visit("s1", 9, "p1", "123") + visit("s1", 9, "p1", "4")))


def test_nobody_left(csv_of: Callable[[str], Path]) -> None:
    """A sentence, not an empty report."""
    path = csv_of("participant,stimulus,question,rating\np1,a,q,3\np2,b,q,4\np2,a,q,\np1,b,q,\np1,c,q,3\np2,c,q,1\n")
    with pytest.raises(BadInput, match="2 started, 0 completed, and nobody is left to analyse"):
        draw_sample(read_ratings(path), AnalysisPlan())


def test_people_who_rated_one_picture_each_are_independent_samples(csv_of: Callable[[str], Path]) -> None:
    """The design decides, unless the plan does."""
    path = csv_of("participant,stimulus,question,rating\np1,a,q,3\np2,b,q,4\np3,a,q,6\np4,b,q,1\n")
    drawn = draw_sample(read_ratings(path), AnalysisPlan())
    assert (drawn.mode, drawn.n_completed) == ("independent", 4)
