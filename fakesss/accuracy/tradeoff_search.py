"""Searching combinations of knob levels for Pareto's front, without trying them all.

Pareto local search (Paquete, Chiarandini and Stützle, *Pareto local optimum sets in the biobjective traveling salesman
problem*, 2004): measure, keep what nothing beats, go on with its neighbours, one step of one knob away. Here the
neighbour measured next is the one that is predicted to beat the front by most, a prediction being the neighbour's
origin with the step's own effect on it, as measured when the knob was turned alone. It starts on a path from the best
of everything to the cheapest, each step the one that costs least error for its time.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from fakesss.accuracy.pareto import gain, non_dominated

Setting = tuple[int, ...]  # of each knob its level's place, 0 the cheapest
Costs = tuple[float, ...]  # time first, then errors; each the less the better
Effects = Sequence[Sequence[Costs]]  # of each knob's levels: time as a factor, errors as sums
HOPELESS = -0.05  # e-folds by which a neighbour may be predicted to lie behind the front and still be measured


def pareto_local_search(
    effects: Effects, best: Setting, measure: Callable[[Setting], Costs], budget: int
) -> dict[Setting, Costs]:
    """What was measured, at most `budget` settings; those that nothing beats are its `front`.

    `effects` are of each knob turned alone, `best` is the most exact setting.
    """
    found: dict[Setting, Costs] = {}
    for setting in spread(downhill(effects, best), max(2, budget // 3)):
        found[setting] = measure(setting)
    while len(found) < budget:
        promising = most_promising(found, effects)
        if promising is None:
            break
        found[promising] = measure(promising)
    return found


def front(found: Mapping[Setting, Costs]) -> list[Setting]:
    """The settings that nothing beats, by rising time."""
    settings = list(found)
    return [settings[place] for place in non_dominated([found[setting] for setting in settings])]


def spread(path: Sequence[Setting], most: int) -> list[Setting]:
    """At most so many of a path, its ends among them."""
    places = np.unique(np.linspace(0, len(path) - 1, min(most, len(path))).round().astype(int))
    return [path[place] for place in places]


def downhill(effects: Effects, best: Setting) -> list[Setting]:
    """From the best level of every knob to the cheapest, the step first that saves most time for its error."""
    here = best
    path = [here]
    while any(here):
        steps = [step for step in neighbours(here, effects) if sum(step) < sum(here)]
        here = min(steps, key=lambda step: price(here, step, effects))
        path.append(here)
    return path


def price(here: Setting, there: Setting, effects: Effects) -> float:
    """Error added for each e-fold of time that a step saves; last what saves none."""
    knob = next(place for place, (a, b) in enumerate(zip(here, there, strict=True)) if a != b)
    before, after = effects[knob][here[knob]], effects[knob][there[knob]]
    saved = float(np.log(before[0] / after[0]))
    added = max(after[1] - before[1], 0.0)
    return added / saved if saved > 1e-3 else 1e6 + added


def neighbours(setting: Setting, effects: Effects) -> Iterator[Setting]:
    """The settings one level of one knob away."""
    for knob, place in enumerate(setting):
        for other in (place - 1, place + 1):
            if 0 <= other < len(effects[knob]):
                yield (*setting[:knob], other, *setting[knob + 1 :])


def most_promising(found: Mapping[Setting, Costs], effects: Effects) -> Setting | None:
    """The unmeasured neighbour of the front that is predicted to beat it by most; None where all are hopeless."""
    best = front(found)
    costs = [found[setting] for setting in best]
    gains: dict[Setting, float] = {}
    for setting in best:
        for other in neighbours(setting, effects):
            if other not in found:
                expected = gain(predicted(found[setting], setting, other, effects), costs)
                gains[other] = min(gains.get(other, np.inf), expected)
    hopeful = {setting: value for setting, value in gains.items() if value > HOPELESS}
    return max(hopeful, key=hopeful.__getitem__) if hopeful else None


def predicted(costs: Costs, here: Setting, there: Setting, effects: Effects) -> Costs:
    """What `there` should cost: that of `here`, its time times the step's factor, its errors plus the step's."""
    for knob, (a, b) in enumerate(zip(here, there, strict=True)):
        before, after = effects[knob][a], effects[knob][b]
        errors = (max(e + y - x, 0.0) for e, x, y in zip(costs[1:], before[1:], after[1:], strict=True))
        costs = (costs[0] * after[0] / before[0], *errors)
    return costs
