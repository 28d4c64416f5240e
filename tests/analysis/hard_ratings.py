"""Ratings that break statistics programs: each case a CSV file, how it is read, and the sentence a user gets."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from random import Random
from typing import Any

HEAD = "participant,stimulus,question,rating\n"
Rule = Callable[[int, int], object]


@dataclass(frozen=True)
class Hard:
    """A file of ratings. `said`: words of a warning or, where `refused`, of the one sentence instead of a report."""

    name: str
    text: str
    said: str
    refused: bool = False
    options: Mapping[str, Any] = field(default_factory=dict)
    plan: Mapping[str, Any] = field(default_factory=dict)


def scattered(who: int, what: int) -> int:
    """A rating 1..7 with an effect of the picture, of the person, and what looks like noise."""
    return min(7, max(1, 3 + what % 3 + (who % 3 == 0) + (7 * who * who + 5 * what * who + 3 * what) % 4 - 1))


def ratings(rule: Rule = scattered, people: int = 9, pictures: tuple[str, ...] = ("a", "b", "c")) -> str:
    """CSV text of complete ratings on one question; `rule(person, picture)` counts both from 0."""
    cells = ((who, place, name) for who in range(people) for place, name in enumerate(pictures))
    return HEAD + "".join(f'p{who},"{name}",shiny,{rule(who, place)}\n' for who, place, name in cells)


def without(text: str, *lines: str) -> str:
    """The text less the lines that begin like one of `lines`."""
    return "".join(line for line in text.splitlines(keepends=True) if not line.startswith(lines))


def changed(text: str, **cells: str) -> str:
    """The text with the rating of the named cells (p1_a="": person p1, picture a) replaced."""
    lines = []
    for line in text.splitlines():
        who, what, question, given = line.replace('"', "").split(",")
        lines.append(f"{who},{what},{question},{cells.get(f'{who}_{what}', given)}")
    return "\n".join(lines) + "\n"


def offset(who: int, what: int) -> float:
    """A visual analogue scale whose zero lies 1e12 away."""
    return 1e12 + 10 * scattered(who, what)


EVERYBODY = {"completers_only": False}
NAMES = ("C", "C(x)", 'say ""glow""', "a b", "Q('y')", "Ω≈ç", "np.exp(1)", "0", "True", "lambda")
FACTORIAL = "participant,stimulus,question,rating,light\n"

CASES = (
    Hard("all ratings equal", ratings(lambda who, what: 4), "all ratings are equal, so F has no value"),
    Hard(
        "each picture constant, repeated",
        ratings(lambda who, what: 2 + what),
        "every participant shows exactly the same differences, so there is no error to test them against",
    ),
    Hard(
        "each group constant, independent",
        HEAD + "".join(f"p{who},{'abc'[who % 3]},shiny,{2 + who % 3}\n" for who in range(12)),
        "within each level all ratings are equal, so F has no value",
    ),
    Hard(
        "zero residual",
        ratings(lambda who, what: 1 + who % 4 + what),
        "every participant shows exactly the same differences",
    ),
    Hard("NaN written out", changed(ratings(), p1_a="NaN"), 'line 5: rating "NaN": must be', refused=True),
    Hard("an empty rating", changed(ratings(), p1_a=""), "1 answer missing", plan=EVERYBODY),
    Hard(
        "a missing cell",
        without(ratings(), 'p1,"a"'),
        "1 participant with a missing cell left out: p1",
        plan=EVERYBODY,
    ),
    Hard(
        "a doubled answer",
        ratings() + "p1,a,shiny,3\n",
        'participant "p1" rated "a" on "shiny" twice; delete one line',
        refused=True,
    ),
    Hard("one participant", ratings(people=1), "1 of 1 participants rated every level; at least two must have"),
    Hard(
        "two people, two pictures",
        HEAD + "p1,a,shiny,1\np1,b,shiny,2\np2,a,shiny,3\np2,b,shiny,6\n",
        "4 ratings in complete rows; the ICC needs at least 5",
    ),
    Hard("one picture", ratings(pictures=("a",)), "1 level with ratings; a comparison needs at least two"),
    Hard(
        "fewer people than pictures",
        ratings(people=4, pictures=tuple("abcdef")),
        "4 participants for 6 levels; sphericity cannot be judged",
    ),
    Hard("two pictures", ratings(pictures=("a", "b")), ""),
    Hard("image 10 after image 2", ratings(pictures=("image 10", "image 2", "image 1")), ""),
    Hard("names like formulas", ratings(pictures=NAMES, people=14), ""),
    Hard("rating 0", changed(ratings(), p1_a="0"), 'rating "0": must be a whole number from 1 to 7', refused=True),
    Hard("rating 8", changed(ratings(), p1_a="8"), 'rating "8": must be a whole number from 1 to 7', refused=True),
    Hard(
        "rating 3.5", changed(ratings(), p1_a="3.5"), 'rating "3.5": must be a whole number from 1 to 7', refused=True
    ),
    Hard(
        "rating four",
        changed(ratings(), p1_a="four"),
        'rating "four": must be a whole number from 1 to 7',
        refused=True,
    ),
    Hard(
        "perfect separation",
        ratings(lambda who, what: 1 + 3 * what - (who % 2) * (what > 0)),
        'every rating at picture "c" is at or above every rating elsewhere, so an odds ratio is infinite',
    ),
    Hard(
        "no differences between people",
        ratings(lambda who, what: 2 + what + (who + what) % 3),
        "the variance of participants is 0",
    ),
    Hard("ties everywhere", ratings(lambda who, what: 4 if who else 3 + what), "the variance of participants is 0"),
    Hard("everybody ties", ratings(lambda who, what: 1 + who % 7), "every participant shows exactly the same"),
    Hard(
        "equivalence without spread",
        ratings(lambda who, what: scattered(who, min(what, 1))),
        "without spread there is no test",
        plan={"equivalence": {"margin": 0.5}},
    ),
    Hard("an offset of 1e12", ratings(offset), "", options={"scale": None}),
    Hard(
        "labels in two spellings",
        ratings() + "p1 ,A,shiny,3\np2,A,shiny,4\n",
        'Pictures "A" and "a" differ in case or spaces alone and count as 2',
        plan=EVERYBODY,
    ),
    Hard(
        "most answers at the ceiling", ratings(lambda who, what: 7 - (who * what) % 3 // 2), "are 7, the highest on the"
    ),
    Hard(
        "significant without agreement",
        ratings(lambda who, what: min(7, Random(7 * who + what).randint(1, 6) + (what == 1)), people=150),
        "1 test is significant although raters hardly agree (Krippendorff’s α = .0",
        plan={"tests": ["ranks"]},
    ),
    Hard(
        "a p below what float64 holds",
        ratings(lambda who, what: 1 + 3 * what - (what and who % 50 == what), people=400),
        "",
        plan={"tests": ["ranks"]},
    ),
    Hard("a file without rows", HEAD, "has a header but no ratings", refused=True),
    Hard("an empty file", "", "is empty; it needs a header line", refused=True),
    Hard(
        "decimal commas between commas",
        HEAD + "p1,a,shiny,3,5\n",
        "line 2: has 5 cells, the header 4",
        refused=True,
        options={"scale": None},
    ),
    Hard(
        "a factor with one level",
        FACTORIAL
        + "".join(f"p{who},{what},shiny,{scattered(who, ord(what))},1\n" for who in range(5) for what in "ab"),
        'factor light: has only the level "1"; a factor needs two levels',
        refused=True,
        options={"factors": {"light": "light"}},
    ),
    Hard(
        "a picture with two levels",
        FACTORIAL + "p1,a,shiny,3,1\np1,b,shiny,4,2\np2,a,shiny,4,2\np2,b,shiny,5,2\n",
        'line 4: picture "a" has light "2" here and "1" before',
        refused=True,
        options={"factors": {"light": "light"}},
    ),
)


def finite(value: object) -> bool:
    """Whether a number of results.json is one."""
    return not isinstance(value, float) or math.isfinite(value)
