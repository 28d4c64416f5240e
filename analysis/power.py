"""Power by simulation: in what share of simulated studies the declared tests reject, and how many people it takes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache
from math import inf
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import special
from statsmodels.stats.proportion import proportion_confint

from analysis.planned_tests import PlannedTest
from analysis.statistics.batches import Moments
from analysis.statistics.multiplicity import adjusted
from analysis.statistics.undefined import Floats

Draw = Callable[[str, int, int, np.random.Generator], npt.NDArray[np.floating[Any]]]
Progress = Callable[[int, int], None]
FEWEST = 2
CONFIDENCE = 0.95
MEMORY = 4_000_000  # answers to a question and covariances held at once, at the most
USUAL_MOST = 1000
GRAIN = 0.01  # of the limits of a number of people


@dataclass(frozen=True)
class Power:
    """A share of simulated studies, with Clopper and Pearson's 95% interval of its Monte-Carlo error."""

    share: float
    low: float
    high: float


@cache
def power_of(rejections: int, studies: int) -> Power:
    """From a count."""
    low, high = proportion_confint(rejections, studies, alpha=1 - CONFIDENCE, method="beta")
    return Power(rejections / studies, float(low), float(high))


@dataclass
class Simulation:
    """Studies simulated by `draw`, and what their tests found.

    `draw(question, people, studies, random)` returns answers of shape (people, studies, pictures), pictures in the
    order of the manifest, and uses random numbers person by person: studies of more people then begin with the same
    ones, so that power rises with their number almost without scatter. `pictures`: how many there are. Everything
    follows from `seed`. A test without a value in a study (all answers equal) counts as not rejecting.
    """

    tests: Sequence[PlannedTest]
    draw: Draw
    pictures: int
    studies: int
    seed: int
    found: dict[int, tuple[int, ...]] = field(default_factory=dict)

    def simulate(self, people: int, progress: Progress | None = None) -> None:
        """Counts for each test the studies with so many people in which it rejects; each size is simulated once.

        `progress(people, studies)` is called after every block of studies, which is the same for any number of people.
        """
        if people in self.found:
            return
        count = np.zeros(len(self.tests), dtype=np.int64)
        size = max(1, MEMORY // (self.pictures * max(self.pictures, USUAL_MOST)))
        for block, start in enumerate(range(0, self.studies, size)):
            studies = min(size, self.studies - start)
            count += self.decided(self.p_values(people, block, studies)).sum(axis=0)
            if progress is not None:
                progress(people, studies)
        self.found[people] = tuple(map(int, count))

    def p_values(self, people: int, block: int, studies: int) -> Floats:
        """(studies, tests), not yet adjusted."""
        p = np.full((studies, len(self.tests)), np.nan)
        for number, question in enumerate(dict.fromkeys(test.question for test in self.tests)):
            random = np.random.default_rng([self.seed, number, block])
            moments = Moments.of(self.draw(question, people, studies, random))
            for place, test in enumerate(self.tests):
                if test.question == question:
                    p[:, place] = test.p(moments)
        return p

    def decided(self, p: Floats) -> npt.NDArray[np.bool_]:
        """(studies, tests): which reject, the tests of each family adjusted together."""
        deciding = p.copy()
        for family, method in dict.fromkeys((test.family, test.adjust) for test in self.tests):
            places = [place for place, test in enumerate(self.tests) if (test.family, test.adjust) == (family, method)]
            if method != "none":
                deciding[:, places] = adjusted(p[:, places], method)
        rejects: npt.NDArray[np.bool_] = deciding < np.array([test.alpha for test in self.tests])
        return rejects

    def power(self, test: int, people: int) -> Power:
        """Of the test at index `test`; `people` must be simulated."""
        return power_of(self.found[people][test], self.studies)


@dataclass(frozen=True)
class Bracket:
    """What the sizes simulated so far say of the smallest with enough power: more than `below`, at most `enough`.

    `at_below`, `at_enough`: the power, or a limit of it, with these. `grain`: the bracket is closed when no wider than
    this share of the size.
    """

    below: int | None
    enough: int | None
    at_below: float = 0.0
    at_enough: float = 1.0
    grain: float = 0.0

    @property
    def closed(self) -> bool:
        """Whether the smallest size is known."""
        if self.enough is None:
            return False
        return self.enough - (self.below or FEWEST - 1) <= max(1, self.grain * self.enough)

    def next(self, target: float, most: int) -> int | None:
        """The size to simulate next; None where nothing is left to learn up to `most`.

        Doubles until it is enough. Then, the probit of power rising about as the root of the size, where a line reaches
        the target; at least an eighth from both ends, so that every step takes a part of the bracket away.
        """
        if self.closed or self.below == most:
            return None
        if self.enough is None:
            return min(most, max(2 * (self.below or 0), 8))
        below = self.below or FEWEST - 1
        low, high, wanted = map(float, special.ndtri(np.clip([self.at_below, self.at_enough, target], 1e-3, 1 - 1e-3)))
        share = (wanted - low) / (high - low) if high > low else 0.5
        guess: int = round((below**0.5 + share * (self.enough**0.5 - below**0.5)) ** 2)
        margin = max(1, (self.enough - below) // 8)
        return min(max(guess, below + margin), self.enough - margin)


@dataclass(frozen=True)
class Search:
    """The smallest number of people, up to `most`, with which a test has at least the power `target`.

    The limits of the number are those with which the upper and the lower limit of power reach the target: numbers
    outside them have a power whose interval excludes it. They are found to a hundredth, rounded away from the number.
    """

    simulation: Simulation
    target: float
    most: int

    def run(self, asked: Sequence[int] = (), progress: Progress | None = None) -> None:
        """Simulates the sizes asked for, and on until every test that has a chance has its number and both limits."""
        for people in asked:
            self.simulation.simulate(people, progress)
        while (size := self.next()) is not None:
            self.simulation.simulate(size, progress)

    def next(self) -> int | None:
        """A size that some test still needs; None where nothing is left to learn. Each size tells of all tests."""
        for test, planned in enumerate(self.simulation.tests):
            for bound in ("share", "high", "low") if not planned.hopeless else ():
                if (size := self.bracket(test, bound).next(self.target, self.most)) is not None:
                    return size
        return None

    def bracket(self, test: int, bound: str) -> Bracket:
        """By the sizes simulated so far. `bound`: "share", or the limit "low" or "high" of power that has to reach."""
        power = {size: getattr(self.simulation.power(test, size), bound) for size in self.simulation.found}
        enough = min((size for size in power if power[size] >= self.target), default=None)
        below = max((size for size in power if power[size] < self.target and size < (enough or inf)), default=None)
        at_below, at_enough = power[below] if below else 0.0, power[enough] if enough else 1.0
        return Bracket(below, enough, at_below, at_enough, grain=0.0 if bound == "share" else GRAIN)
