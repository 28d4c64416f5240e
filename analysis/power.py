"""Power by simulation: in what share of simulated studies the declared tests reject, and how many people it takes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from statsmodels.stats.proportion import proportion_confint

from analysis.planned_tests import PlannedTest
from analysis.statistics.batches import Moments, adjusted_p
from analysis.statistics.undefined import Floats

Draw = Callable[[str, int, int, np.random.Generator], Floats]
Progress = Callable[[int, int], None]
FEWEST = 2
CONFIDENCE = 0.95
MEMORY = 4_000_000  # answers to a question and covariances held at once, at the most
USUAL_MOST = 1000


@dataclass(frozen=True)
class Power:
    """A share of simulated studies, with Clopper and Pearson's 95% interval of its Monte-Carlo error."""

    share: float
    low: float
    high: float

    @classmethod
    def of(cls, rejections: int, studies: int) -> "Power":
        """From a count."""
        low, high = proportion_confint(rejections, studies, alpha=1 - CONFIDENCE, method="beta")
        return cls(rejections / studies, float(low), float(high))


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
        adjusted = p.copy()
        for family, method in dict.fromkeys((test.family, test.adjust) for test in self.tests):
            places = [place for place, test in enumerate(self.tests) if (test.family, test.adjust) == (family, method)]
            adjusted[:, places] = adjusted_p(p[:, places], method)
        rejects: npt.NDArray[np.bool_] = adjusted < np.array([test.alpha for test in self.tests])
        return rejects

    def power(self, test: int, people: int) -> Power:
        """Of the test at index `test`; `people` must be simulated."""
        return Power.of(self.found[people][test], self.studies)


@dataclass(frozen=True)
class Bracket:
    """What the sizes simulated so far say of the smallest with enough power: more than `below`, at most `enough`."""

    below: int | None
    enough: int | None

    @property
    def closed(self) -> bool:
        """Whether the smallest size is known: `enough`."""
        return self.enough == FEWEST or (self.enough is not None and self.below == self.enough - 1)

    def next(self, most: int) -> int | None:
        """The size to simulate next; None where nothing is left to learn up to `most`."""
        if self.closed or self.below == most:
            return None
        if self.enough is None:
            return min(most, max(2 * (self.below or 0), 8))
        return ((self.below or FEWEST - 1) + self.enough) // 2


@dataclass(frozen=True)
class Search:
    """The smallest number of people, up to `most`, with which a test has at least the power `target`.

    Brackets by doubling, then halves. The limits of the number are those with which the upper and the lower limit of
    power reach the target: numbers outside them, simulated, would have a power whose interval excludes the target.
    """

    simulation: Simulation
    target: float
    most: int

    def run(self, asked: Sequence[int] = (), progress: Progress | None = None) -> None:
        """Simulates the sizes asked for, and on until every test that has a chance has its number and both limits."""
        for size in asked:
            self.simulation.simulate(size, progress)
        for test, planned in enumerate(self.simulation.tests):
            for bound in ("high", "share", "low") if not planned.hopeless else ():
                while (people := self.bracket(test, bound).next(self.most)) is not None:
                    self.simulation.simulate(people, progress)

    def bracket(self, test: int, bound: str) -> Bracket:
        """By the sizes simulated so far. `bound`: "share", or the limit "low" or "high" of power that has to reach."""
        powers = {people: self.simulation.power(test, people) for people in self.simulation.found}
        enough = {people: getattr(power, bound) >= self.target for people, power in powers.items()}
        reached = min((people for people, yes in enough.items() if yes), default=None)
        below = [people for people, yes in enough.items() if not yes and (reached is None or people < reached)]
        return Bracket(max(below, default=None), reached)
