"""People whose answers stand out by a stated bound: shown, not removed."""

import math
from collections.abc import Hashable, Mapping

import pandas as pd

from analysis.quality import TOO_FAST_MS
from analysis.study import StudyInfo
from analysis.tables import Table
from analysis.wording import counted, no_zero

SAME_ANSWER = 0.8  # share of the answers that are one and the same
RUN = 10  # equal answers one after the other
TOO_FAST = 0.1  # share of the answers
FOCUS_MS = 30_000.0
FENCE = 1.5  # interquartile ranges
RETEST = 1 / 3  # of the scale's length, between showings of one picture

Entry = Mapping[Hashable, float]


def with_reasons(table: pd.DataFrame, study: StudyInfo) -> pd.DataFrame:
    """`quality_table` with the column `stands_out`: every reason in words, empty for most people.

    Correlation and retest are judged against the other people too (Tukey's fences, 1977: 1.5 interquartile ranges):
    where nobody agrees, a person who does not is no exception.
    """
    scales = [q.scale for q in study.questions if q.scale is not None]
    far = max(RETEST * (min(scales) - 1) if scales else math.inf, fence(table["retest_difference"], 0.75))
    against = min(0.0, fence(table["person_rest_r"], 0.25))
    return table.assign(stands_out=["; ".join(reasons(entry, far, against)) for entry in table.to_dict("records")])


def fence(values: "pd.Series[float]", quartile: float) -> float:
    """Tukey's fence beyond the quartile; NaN without values."""
    q1, q3 = values.quantile(0.25), values.quantile(0.75)
    return float(q1 - FENCE * (q3 - q1) if quartile < 0.5 else q3 + FENCE * (q3 - q1))


def reasons(entry: Entry, far: float, against: float) -> list[str]:
    """In the order of their weight. A measure that the file does not tell (NaN) is below every bound."""
    said = []
    if entry["failed_checks"] >= 1:
        said.append(f"failed {counted(int(entry['failed_checks']), 'check')}")
    if entry["same_answer_share"] >= SAME_ANSWER and entry["ratings"] > 1:
        said.append("one answer to nearly everything" if entry["same_answer_share"] < 1 else "one answer to everything")
    elif entry["longest_run"] >= RUN:
        said.append(f"{entry['longest_run']:.0f} equal answers in a row")
    if entry["too_fast_share"] >= TOO_FAST:
        said.append("too fast")
    if entry["person_rest_r"] < against:
        said.append("rates against the others")
    if entry["retest_difference"] > far:
        said.append("far from the own answer on a second showing")
    if entry["focus_lost_ms"] >= FOCUS_MS:
        said.append("looked away")
    if entry["missing"]:
        said.append(counted(int(entry["missing"]), "answer") + " missing")
    return said


def summary_of(table: pd.DataFrame) -> str:
    """One sentence: how many stand out, and that standing out removes nobody."""
    odd = int((table["stands_out"] != "").sum())
    people = counted(len(table), "participant")
    if not odd:
        return f"Answer quality: none of {people} stands out."
    used = int(((table["stands_out"] != "") & table["analysed"]).sum())
    verb, are = ("stands", "is") if odd == 1 else ("stand", "are")
    which = f"all {are} analysed" if used == odd else f"{used} of them {'is' if used == 1 else 'are'} analysed"
    which = "and is analysed" if odd == used == 1 else which
    if not used:
        return f"Answer quality: {odd} of {people} {verb} out; {'none of them is' if odd > 1 else 'not'} analysed."
    return f"Answer quality: {odd} of {people} {verb} out; {which}, as only declared rules leave anybody out."


def table_of_those(table: pd.DataFrame, too_fast_ms: float = TOO_FAST_MS) -> Table | None:
    """Those who stand out, with their measures; None where nobody does."""
    odd = table[table["stands_out"] != ""]
    if odd.empty:
        return None
    rows = tuple(
        (
            str(entry["participant"]),
            str(entry["stands_out"]),
            "yes" if entry["analysed"] else "no",
            f"{entry['ratings']:.0f}",
            share(entry["same_answer_share"]),
            whole(entry["longest_run"]),
            seconds(entry["median_rt_ms"]),
            share(entry["too_fast_share"]),
            "–" if math.isnan(entry["retest_difference"]) else f"{entry['retest_difference']:.2f}",
            "–" if math.isnan(entry["person_rest_r"]) else no_zero(entry["person_rest_r"], 2),
        )
        for entry in odd.to_dict("records")
    )
    head = ("Participant", "Why", "Analysed", "Ratings", "Commonest answer", "Longest run", "Median s", "Too fast")
    return Table(
        "table-quality",
        "Participants whose answers stand out",
        (*head, "Retest |d|", "r with others"),
        rows,
        text_columns=3,
        note=f"Stands out: a failed check; one answer in {SAME_ANSWER:.0%} of the ratings or {RUN} times in a row; "
        f"{TOO_FAST:.0%} of the answers faster than {too_fast_ms:g} ms; {FOCUS_MS / 1000:g} s away from the page; "
        "answers missing; a correlation with the mean of the others (question means taken out) below 0, or showings of "
        f"one picture rated more than a third of the scale apart, if it is also {FENCE:g} interquartile ranges beyond "
        "most people’s. – : the file does not tell. Everyone: tables/participants.csv.",
    )


def share(value: float) -> str:
    """12%."""
    return "–" if math.isnan(value) else f"{value:.0%}"


def whole(value: float) -> str:
    """7."""
    return "–" if math.isnan(value) else f"{value:.0f}"


def seconds(value: float) -> str:
    """Milliseconds as seconds."""
    return "–" if math.isnan(value) else f"{value / 1000:.1f}"
