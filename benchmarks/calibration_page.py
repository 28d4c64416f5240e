"""docs/calibration.md: the table of rates, and the rates that its words name.

The table stands between `TABLE` and `END`. In the words, every rate has a mark behind it, `4.0%<!--gg-8-->`; a list in
a comment at the page's end says of each mark `claim | ratings | verdicts`: the row that the rate is of, and the
verdicts (" or " between) with which the sentence still holds.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from statsmodels.stats.proportion import proportion_confint

from benchmarks.calibration_batches import ALPHA

PAGE = Path(__file__).parents[1] / "docs" / "calibration.md"
TABLE, END = "<!-- table: written by python -m benchmarks.calibration -->\n", "\n<!-- end of table -->"
MARKED = re.compile(r"(\d+\.\d%)<!--([\w-]+)-->")
LISTED = re.compile(r"^([\w-]+) = (.+?) \| (.+?) \| (.+?)$", re.MULTILINE)
HEAD = ("what is claimed", "ratings", "studies", "stated", "found", "Monte-Carlo 95%", "verdict")


@dataclass(frozen=True)
class Count:
    """A claim on one kind of ratings held in `hits` of `studies` studies."""

    claim: str
    ratings: str
    hits: int
    studies: int

    @property
    def rate(self) -> str:
        """Found, as the page says it."""
        return f"{self.hits / self.studies:.1%}"

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson's, 95%."""
        low, high = proportion_confint(self.hits, self.studies, method="wilson")
        return float(low), float(high)

    @property
    def verdict(self) -> str:
        """In words, after Bradley (1978), Br. J. Math. Stat. Psychol. 31: a rate within a tenth of alpha of what is
        stated is kept (his stringent criterion), one within half of alpha a small fault (his liberal one)."""
        goal, (low, high) = stated(self.claim), self.interval
        off, room = abs(self.hits / self.studies - goal), min(goal, 1 - goal)
        test = goal < 0.5
        if low <= goal <= high or off <= 0.1 * room:
            return "keeps its level" if test else "covers"
        slightly = "slightly " if off <= 0.5 * room else ""
        if test:
            return slightly + ("liberal" if low > goal else "cautious")
        return slightly + ("too narrow" if high < goal else "wider than need be")


def stated(claim: str) -> float:
    """The rate that a claim promises: the coverage it names, else the level of the tests."""
    return {"95%": 0.95, "90%": 0.90}.get(claim[:3], ALPHA)


def table(counts: Sequence[Count]) -> str:
    """A row per claim and ratings: tests first, the rows of one claim together, which is named once above them."""
    order = list(dict.fromkeys(count.claim for count in counts))
    lines, last = [f"| {' | '.join(HEAD)} |", "|" + "---|" * len(HEAD)], ""
    for count in sorted(counts, key=lambda one: (stated(one.claim) > 0.5, order.index(one.claim))):
        low, high = count.interval
        numbers = (f"{count.studies:,}", f"{stated(count.claim):.0%}", count.rate, f"{low:.1%} to {high:.1%}")
        name = "" if count.claim == last else count.claim
        lines.append(f"| {' | '.join((name, count.ratings, *numbers, count.verdict))} |")
        last = count.claim
    return "\n".join(lines)


def updated(text: str, counts: Sequence[Count]) -> tuple[str, list[str]]:
    """The page with table and marked rates of these counts, and a line for each rate that no longer fits its words."""
    before, rest = text.split(TABLE)
    after = rest.split(END)[1]
    listed = {mark: facts for mark, *facts in LISTED.findall(after)}
    found = {(count.claim, count.ratings): count for count in counts}
    unfit: list[str] = []

    def rate(match: re.Match[str]) -> str:
        """The marked rate as the table has it now."""
        mark = match[2]
        if mark not in listed:
            unfit.append(f"mark {mark}: stands in the words and not in the list")
            return match[0]
        claim, ratings, verdicts = listed[mark]
        count = found.get((claim, ratings))
        if count is None:
            unfit.append(f"mark {mark}: the table has no row {claim} | {ratings}")
            return match[0]
        if count.verdict not in verdicts.split(" or "):
            line = before[: match.start()].count("\n") + 1
            unfit.append(f"line {line}, {mark}: {claim} | {ratings}: {count.rate}, {count.verdict}; not {verdicts}")
        return f"{count.rate}<!--{mark}-->"

    words = MARKED.sub(rate, before)
    unused = sorted(set(listed) - {mark for _, mark in MARKED.findall(before)})
    unfit += [f"mark {mark}: stands in the list and not in the words" for mark in unused]
    return words + TABLE + table(counts) + END + after, unfit
