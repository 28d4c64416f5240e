"""Searching combinations of knob levels for Pareto's front, without trying them all.

Pareto local search (Paquete, Chiarandini and Stützle, *Pareto local optimum sets in the biobjective traveling salesman
problem*, 2004): measure, keep what nothing beats, go on with its neighbours, one knob otherwise. Here the
neighbour measured next is the one that is predicted to beat the front by most, a prediction being the neighbour's
origin with the step's own effect on it, as measured when the knob was turned alone. It starts on a path from the best
of everything to where nothing saves time any more, each step the one that costs least error for its time. Times nearer
than `ALIKE` are equal here, and the smaller error counts: a few rounds tell no better.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from fakesss.accuracy.pareto import gain, unbeaten

Setting = tuple[int, ...]  # of each knob its level's place
Costs = tuple[float, ...]  # time first, then errors; each the less the better
Effects = Sequence[Sequence[Costs]]  # of each knob's levels: time as a factor, errors as sums
ALIKE = 1.03  # factor between times that count as equal
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
    costs = [found[setting] for setting in settings]
    kept = unbeaten([one[1:] for one in costs], lambda a, b: saves(costs[a], costs[b]))
    return [settings[place] for place in sorted(kept, key=lambda place: costs[place])]


def saves(one: Costs, other: Costs) -> bool:
    """Whether `one` takes less time by more than counts as equal."""
    return one[0] * ALIKE < other[0]


def below(
    found: dict[Setting, Costs],
    effects: Effects,
    measure: Callable[[Setting], Costs],
    fine: Callable[[Costs], bool],
) -> None:
    """Look at what is cheaper than the cheapest `fine` setting, one knob otherwise, until nothing there is fine.

    Of each knob that is the level which, of those that save time, is the most exact. Adds to `found`.
    """
    while some := [setting for setting in found if fine(found[setting])]:
        here = min(some, key=lambda setting: found[setting])
        new = [setting for setting in cheaper(here, effects) if setting not in found]
        if not new:
            return
        found.update((setting, measure(setting)) for setting in new)


def cheaper(here: Setting, effects: Effects) -> Iterator[Setting]:
    """Of every knob the most exact level that saves time."""
    for knob, (place, levels) in enumerate(zip(here, effects, strict=True)):
        saving = [other for other, level in enumerate(levels) if saves(level, levels[place])]
        if saving:
            least = min(saving, key=lambda other: levels[other][:0:-1])
            yield (*here[:knob], least, *here[knob + 1 :])


def spread(path: Sequence[Setting], most: int) -> list[Setting]:
    """At most so many of a path, its ends among them."""
    places = np.unique(np.linspace(0, len(path) - 1, min(most, len(path))).round().astype(int))
    return [path[place] for place in places]


def downhill(effects: Effects, best: Setting) -> list[Setting]:
    """From the best level of every knob to where none saves time, the step first that adds least error for its time."""
    path = [best]
    while steps := [step for step in neighbours(path[-1], effects) if price(path[-1], step, effects) is not None]:
        path.append(min(steps, key=lambda step: price(path[-1], step, effects) or 0.0))
    return path


def price(here: Setting, there: Setting, effects: Effects) -> float | None:
    """Error added for each e-fold of time that a step saves; None where it saves none."""
    knob = next(place for place, (a, b) in enumerate(zip(here, there, strict=True)) if a != b)
    before, after = effects[knob][here[knob]], effects[knob][there[knob]]
    added = max(after[1] - before[1], 0.0)
    return float(added / np.log(before[0] / after[0])) if saves(after, before) else None


def neighbours(setting: Setting, effects: Effects) -> Iterator[Setting]:
    """The settings that have another level of one knob."""
    for knob, place in enumerate(setting):
        for other in range(len(effects[knob])):
            if other != place:
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
