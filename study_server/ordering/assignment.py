"""What each participant is shown in which order: rows of a seeded design. Pure functions; nothing is stored here."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import gcd, lcm
from random import Random
from typing import Literal

from study_server.ordering.repeats import insert_repeats
from study_server.ordering.williams import shuffled_rows, williams_row, williams_rows

Order = Literal["latin-square", "random"]
Blocks = Literal["together", "by-question"]

MOST_ROWS = 400
"""Rows of `random`: one each for the largest study this is made for; then they are given a second time. A
`latin-square` that would need more is not crossed with all orders of the questions: rows that nobody gets balance
nothing."""


@dataclass(frozen=True)
class Trial:
    """One picture as one order row shows it."""

    stimulus: str
    questions: tuple[str, ...]
    """Names of the questions asked under it, in the study's order."""
    check: int | None = None
    """The answer that an instructed item under this picture asks for ("choose 2 here"); None: no such item."""


@dataclass(frozen=True)
class Design:
    """Everything that the orders depend on. Equal designs have equal rows, however `repeats` is sorted.

    Raises `ValueError` for no picture, no question, a repeat of what is no stimulus, a second repeat of one picture,
    or more `checks` than `most_checks`.
    """

    stimuli: tuple[str, ...]
    """Every picture that is no repeat, in the manifest's order."""
    repeats: Mapping[str, str]
    """Id of a repeated showing -> id of the stimulus that it shows again."""
    questions: tuple[str, ...]
    steps: tuple[int, ...]
    """Steps of each question's scale, 2 .. 11. An instructed item has that of the last question asked with it."""
    order: Order = "latin-square"
    blocks: Blocks = "together"
    checks: int = 0
    practice: int = 0
    seed: int = 0

    def __post_init__(self) -> None:
        if not self.stimuli or not self.questions:
            raise ValueError("a design needs a picture and a question")
        originals = list(self.repeats.values())
        if len(set(originals)) < len(originals) or not set(originals) <= set(self.stimuli):
            raise ValueError("each repeat shows another stimulus of the study again")
        if self.checks > most_checks(self.trials):
            raise ValueError(f"{self.checks} checks in {self.trials} trials: at most {most_checks(self.trials)}")

    @cached_property
    def groups(self) -> list[tuple[str, ...]]:
        """The questions of each block: all together, or one in each."""
        return [self.questions] if self.blocks == "together" else [(question,) for question in self.questions]

    @property
    def trials(self) -> int:
        """Trials of a session without practice."""
        return len(self.groups) * (len(self.stimuli) + len(self.repeats))

    def rows(self) -> list[list[Trial]]:
        """The order rows, each a whole session without practice: blocks, with repeats, then instructed items.

        Pictures are in the orders of `picture_orders`, repeats where `insert_repeats` puts them. By question, the
        questions' own order is a Williams design too, row after row: in each turn of it every question is in every
        place equally often and directly after every other equally often.
        """
        random = self.lots("repeats")
        questions = question_orders(len(self.groups), self.lots("questions"))
        scales = dict(zip(self.questions, self.steps, strict=True))
        used = [[0] * (len(self.stimuli) + len(self.repeats)) for _ in self.groups]
        rows = []
        for number, pictures in enumerate(self.picture_orders(questions)):
            turn = questions[number % len(questions)]
            following = [*(pictures[question][0] for question in turn[1:]), None]
            last = None
            row: list[Trial] = []
            for question, first in zip(turn, following, strict=True):
                shown = insert_repeats(pictures[question], self.repeats, used[question], random, last, first)
                last = self.repeats.get(shown[-1], shown[-1])
                row += [Trial(stimulus, self.groups[question]) for stimulus in shown]
            rows.append(with_checks(row, self.checks, scales, self.lots(f"checks {number}")))
        return rows

    def picture_orders(self, questions: Sequence[Sequence[int]]) -> list[list[list[str]]]:
        """Of each order row, the pictures' order in each question's block, without repeats (one block if together).

        Row i has the blocks in the order `questions[i]`, modulo their number.
        """
        random = self.lots("order")
        if self.order == "random":
            return [shuffles(self.stimuli, questions[i % len(questions)], random) for i in range(MOST_ROWS)]
        return williams_orders(self.stimuli, len(self.groups), random)

    def practice_trials(self) -> list[Trial]:
        """Practice: pictures spread evenly over the design, the same for everybody, so that they show its range.

        One picture comes from the middle of the design; more practice than pictures begins again. Questions are asked
        as later on: all under each picture, or one under each, in turn. No checks, no repeats.
        """
        k, n = len(self.stimuli), self.practice
        if n > k:
            places = [i % k for i in range(n)]
        elif n == 1:
            places = [k // 2]
        else:
            places = [round(i * (k - 1) / (n - 1)) for i in range(n)]
        asked = self.groups
        return [Trial(self.stimuli[place], asked[i % len(asked)]) for i, place in enumerate(places)]

    def lots(self, what: str) -> Random:
        """Random numbers for one part of the design, so that a change in one leaves the others as they are."""
        return Random(f"{what} {self.seed}")


def question_orders(blocks: int, random: Random) -> list[list[int]]:
    """Orders of 0 .. blocks-1: a Williams design, its rows by lot."""
    dealt = random.sample(range(blocks), blocks)
    return [[dealt[number] for number in williams_row(blocks, *row)] for row in shuffled_rows(blocks, random)]


def williams_orders(stimuli: Sequence[str], blocks: int, random: Random) -> list[list[list[str]]]:
    """For each order row the pictures' order in each question's block, rows of one Williams design over the k pictures.

    Let the design have p rows (k or 2k), and the questions' design q (1 if blocks = 1). Then, exactly:
    - In rows 0 .. p-1, p .. 2p-1 and so on each block is the whole Williams design over the pictures: within each
      question every picture in every position and after every other picture equally often. One block: that is all.
    - p q rows cross it with the questions' orders: the same holds within each place of each question's block, so that
      the first blocks alone are a balanced study. They come as turns of lcm(p, q) rows, in each of which pictures and
      questions are balanced separately, so that little is lost if fewer people come.
    - If p q > MOST_ROWS there are as many whole turns as fit; if not even one fits, the fewest multiple of p that is
      not below MOST_ROWS. The first statement then still holds; questions' orders differ in use by 1 at the most.
    One person's blocks are shifts of one row, different if blocks <= k // 2; and from two pictures on no block begins
    with the picture that ends the one before: those are (k + 1) // 2 shifts apart, up or down, ours fewer.
    """
    k = len(stimuli)
    dealt = random.sample(list(stimuli), k)
    base = shuffled_rows(k, random)
    turn = lcm(len(base), williams_rows(blocks))
    turns = min(gcd(len(base), williams_rows(blocks)), max(1, MOST_ROWS // turn))
    rows = turn * turns if turn <= MOST_ROWS else len(base) * -(-MOST_ROWS // len(base))
    half = max(1, k // 2)
    shifts = [block * max(1, half // blocks) % half for block in range(blocks)]
    orders = []
    for number in range(rows):
        square, shift = base[(number + number // turn) % len(base)]
        orders.append([[dealt[i] for i in williams_row(k, square, shift + more)] for more in shifts])
    return orders


def shuffles(stimuli: Sequence[str], turn: Sequence[int], random: Random) -> list[list[str]]:
    """Independent shuffles for each block; none begins with the picture that ends the one before it in `turn`."""
    drawn: dict[int, list[str]] = {}
    last = None
    for block in turn:
        order = random.sample(list(stimuli), len(stimuli))
        while len(stimuli) > 1 and order[0] == last:
            order = random.sample(list(stimuli), len(stimuli))
        drawn[block] = order
        last = order[-1]
    return [drawn[block] for block in range(len(turn))]


def most_checks(trials: int) -> int:
    """Instructed items that a session of `trials` can hold: half, rounded down.

    With more, the first of the equal parts would be the first trial alone, where none may be. Far fewer are wise:
    people mind such items only where they are more than half of a survey (doi 10.31234/osf.io/j8qwk), one alone
    measures attention with error (Berinsky, Margolis and Sances 2014, Separating the shirkers from the workers?,
    American Journal of Political Science 58), and four suffice (the same with Warshaw, Using screeners to measure
    respondent attention on self-administered surveys: which items and how many?).
    """
    return trials // 2


def with_checks(row: Sequence[Trial], n: int, scales: Mapping[str, int], random: Random) -> list[Trial]:
    """`row` with n instructed items: one in each of n equal parts of the trials, at a place drawn by lot.

    Never under the first or last trial (from three trials on): the first is still part of learning the task, and
    after the last nothing is left that a lapse would tell about. The answer asked for is drawn by lot; never the
    middle step, which people give who do not want to choose, and never the answer asked for just before, which one
    line of equal answers would meet. `scales`: each question's steps. Instructed items: Gummer, Rossmann and Silber
    (2021), Sociological Methods and Research 50, 238-264.
    """
    checked = list(row)
    inner = range(1, len(row) - 1) if len(row) >= 3 else range(len(row))
    asked = None
    for i in range(n):
        part = range(i * len(row) // n, (i + 1) * len(row) // n)
        place = random.choice([place for place in part if place in inner])
        steps = scales[row[place].questions[-1]]
        asked = random.choice([step for step in range(1, steps + 1) if 2 * step != steps + 1 and step != asked])
        checked[place] = replace(checked[place], check=asked)
    return checked
