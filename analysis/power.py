"""Power by simulation: in what share of simulated studies the declared tests reject, and how many people it takes."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from functools import cache
from math import inf
from typing import Any, NamedTuple

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


class Count(NamedTuple):
    """Of the studies simulated: in how many a test rejects, and in how many it has no value."""

    rejections: int
    without: int


@dataclass
class Simulation:
    """Studies simulated by `draw`, and what their tests found.

    `draw(question, people, studies, random)` returns answers of shape (people, studies, pictures), pictures in the
    order of the manifest, and uses random numbers person by person: studies of more people then begin with the same
    ones, so that power rises with their number almost without scatter. `pictures`: how many there are; `largest`: the
    most people that will be asked for, which bounds memory. Everything follows from `seed` (and above 1000 people from
    `largest`). A test without a value in a study (all answers equal) counts as not rejecting. `found`: people -> place
    among `tests` -> what was found.
    """

    tests: Sequence[PlannedTest]
    draw: Draw
    pictures: int
    studies: int
    seed: int
    largest: int = USUAL_MOST
    found: dict[int, dict[int, Count]] = field(default_factory=dict)

    def simulate(self, people: int, test: int | None = None, progress: Progress | None = None) -> None:
        """Counts the studies with so many people in which the test at that index rejects; without one, for all tests.

        Other tests of the same answers are counted along, and each test of each size once. `progress(people, studies)`
        is called after every block of studies, which is the same for any number of people.
        """
        known = self.found.get(people, {})
        places = [place for place in self.decided_with(test) if place not in known]
        if not places:
            return
        rejects, without = (np.zeros(len(self.tests), dtype=np.int64) for _ in range(2))
        size = max(1, MEMORY // (self.pictures * max(self.pictures, self.largest, USUAL_MOST)))
        for block, start in enumerate(range(0, self.studies, size)):
            studies = min(size, self.studies - start)
            p = self.p_values(people, block, studies, places)
            rejects += self.decided(p, places).sum(axis=0)
            without += np.isnan(p).sum(axis=0)
            if progress is not None:
                progress(people, studies)
        self.found[people] = known | {place: Count(int(rejects[place]), int(without[place])) for place in places}

    def decided_with(self, test: int | None) -> list[int]:
        """Places of the tests that the answers to a test's questions decide: its own and of tests adjusted with it."""
        if test is None:
            return list(range(len(self.tests)))
        asked = self.questions(test)
        return [place for place in range(len(self.tests)) if self.questions(place) <= asked]

    def questions(self, test: int) -> frozenset[str]:
        """Those whose answers it takes to decide the test at that index."""
        mine = self.tests[test]
        if mine.adjust == "none":
            return frozenset([mine.question])
        return frozenset(each.question for each in self.tests if each.together == mine.together)

    def p_values(self, people: int, block: int, studies: int, places: Collection[int] | None = None) -> Floats:
        """(studies, tests), not yet adjusted; NaN for tests at other places than `places`."""
        p = np.full((studies, len(self.tests)), np.nan)
        wanted = range(len(self.tests)) if places is None else places
        for number, question in enumerate(dict.fromkeys(test.question for test in self.tests)):
            mine = [place for place in wanted if self.tests[place].question == question]
            if mine:
                random = np.random.default_rng([self.seed, number, block])
                moments = Moments.of(self.draw(question, people, studies, random))
                for place in mine:
                    p[:, place] = self.tests[place].p(moments)
        return p

    def decided(self, p: Floats, places: Collection[int] | None = None) -> npt.NDArray[np.bool_]:
        """(studies, tests): which of those at `places` reject, the tests of each family adjusted together."""
        deciding = p.copy()
        wanted = range(len(self.tests)) if places is None else places
        for together in dict.fromkeys(self.tests[place].together for place in wanted):
            family = [place for place in wanted if self.tests[place].together == together]
            if together[1] != "none":
                deciding[:, family] = adjusted(p[:, family], together[1])
        rejects: npt.NDArray[np.bool_] = deciding < np.array([test.alpha for test in self.tests])
        return rejects

    def sizes(self, test: int) -> list[int]:
        """Numbers of people that the test at that index was simulated with."""
        return [people for people, known in self.found.items() if test in known]

    def power(self, test: int, people: int) -> Power:
        """Of the test at index `test`; `people` must be simulated."""
        return power_of(self.found[people][test].rejections, self.studies)


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
            self.simulation.simulate(people, progress=progress)
        while (needed := self.next()) is not None:
            self.simulation.simulate(*needed, progress)

    def next(self) -> tuple[int, int] | None:
        """A size and the place of a test that still needs it; None where nothing is left to learn."""
        for test, planned in enumerate(self.simulation.tests):
            for bound in ("share", "high", "low") if not planned.hopeless else ():
                if (size := self.bracket(test, bound).next(self.target, self.most)) is not None:
                    return size, test
        return None

    def bracket(self, test: int, bound: str) -> Bracket:
        """By the sizes simulated so far. `bound`: "share", or the limit "low" or "high" of power that has to reach."""
        power = {size: getattr(self.simulation.power(test, size), bound) for size in self.simulation.sizes(test)}
        enough = min((size for size in power if power[size] >= self.target), default=None)
        below = max((size for size in power if power[size] < self.target and size < (enough or inf)), default=None)
        at_below, at_enough = power[below] if below else 0.0, power[enough] if enough else 1.0
        return Bracket(below, enough, at_below, at_enough, grain=0.0 if bound == "share" else GRAIN)
