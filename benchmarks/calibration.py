"""Do the tests reject as often as they say, and do the intervals cover? `python -m benchmarks.calibration`.

The table of docs/calibration.md. Simulation i of an experiment depends on the seed, the experiment's name and i alone,
so a run that was stopped is taken up where calibration.json ends. Delete that file after changing a statistic.
"""

import argparse
import json
import zlib
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from statsmodels.stats.proportion import proportion_confint
from tqdm import tqdm

from analysis.statistics.undefined import Undefined
from benchmarks.calibration_cases import ALPHA, Draw, Judge
from benchmarks.calibration_experiments import experiments

RESULTS = Path(__file__).parent / "calibration.json"
SIMULATIONS, SEED, PARTS = 600, 2011, 20
HEAD = ("what is claimed", "ratings", "studies", "stated", "found", "Monte-Carlo 95%", "verdict")


@dataclass
class Tally:
    """What one experiment has said so far: how often each claim held, of how many studies; `silent`: no value."""

    done: int = 0
    silent: int = 0
    hits: Counter[str] = field(default_factory=Counter)

    def add(self, said: Mapping[str, bool] | None) -> None:
        """One study more; None where a statistic had no value."""
        self.done += 1
        self.silent += said is None
        self.hits.update({claim: int(held) for claim, held in (said or {}).items()})


def simulate(tally: Tally, name: str, draw: Draw, judge: Judge, until: int, seed: int) -> None:
    """Studies number `tally.done` to `until` of an experiment."""
    for number in range(tally.done, until):
        frame = draw(np.random.default_rng([seed, zlib.crc32(name.encode()), number]))
        try:
            tally.add(judge(frame))
        except Undefined:
            tally.add(None)


def stated(claim: str) -> float:
    """The rate that a claim promises: the coverage it names, else the level of the tests."""
    return {"95%": 0.95, "90%": 0.90}.get(claim[:3], ALPHA)


def verdict(claim: str, hits: int, n: int) -> str:
    """In words. Bradley (1978), Br. J. Math. Stat. Psychol. 31: within half of alpha of alpha is a small fault."""
    goal, (low, high) = stated(claim), proportion_confint(hits, n, method="wilson")
    test = goal < 0.5
    if low <= goal <= high:
        return "keeps its level" if test else "covers"
    small = abs(hits / n - goal) <= 0.5 * min(goal, 1 - goal)
    if test:
        return ("slightly " if small else "") + ("liberal" if low > goal else "cautious")
    return ("slightly " if small else "") + ("too narrow" if high < goal else "wider than need be")


def table(tallies: Mapping[str, Tally]) -> list[tuple[str, ...]]:
    """A row per claim and data: tests first, the rows of one claim together."""
    found = [(claim, name, tally) for name, tally in tallies.items() for claim in tally.hits]
    order = list(dict.fromkeys(claim for claim, _, _ in found))
    found.sort(key=lambda entry: (stated(entry[0]) > 0.5, order.index(entry[0])))
    rows = []
    for claim, name, tally in found:
        hits, n = tally.hits[claim], tally.done - tally.silent
        low, high = proportion_confint(hits, n, method="wilson")
        ratings, interval = name.rsplit(": ", 1)[-1], f"{low:.1%} to {high:.1%}"
        rows.append(
            (claim, ratings, str(n), f"{stated(claim):.0%}", f"{hits / n:.1%}", interval, verdict(claim, hits, n))
        )
    return rows


def markdown(rows: Iterable[tuple[str, ...]]) -> str:
    """A claim is named once, above its rows."""
    lines, last = [f"| {' | '.join(HEAD)} |", "|" + "---|" * len(HEAD)], ""
    for claim, *rest in rows:
        lines.append(f"| {' | '.join(['' if claim == last else claim, *rest])} |")
        last = claim
    return "\n".join(lines)


def read(path: Path, seed: int) -> dict[str, Tally]:
    """What an earlier run of the same seed has found; nothing where there was none."""
    earlier: dict[str, Any] = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    if earlier.get("seed") != seed:
        return {}
    return {
        name: Tally(entry["studies"], entry["without_value"], Counter(entry["hits"]))
        for name, entry in earlier["experiments"].items()
    }


def write(path: Path, seed: int, tallies: Mapping[str, Tally]) -> None:
    """All tallies, to be taken up again."""
    entries = {
        name: {"studies": tally.done, "without_value": tally.silent, "hits": dict(tally.hits)}
        for name, tally in tallies.items()
    }
    path.write_text(json.dumps({"seed": seed, "experiments": entries}, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    """Simulate, save, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--simulations", type=int, default=SIMULATIONS, help="studies of each experiment")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--out", type=Path, default=RESULTS)
    asked = parser.parse_args()
    planned = experiments()
    earlier = read(asked.out, asked.seed)
    tallies = {each.name: earlier.get(each.name, Tally()) for each in planned}
    goals = {each.name: max(1, round(asked.simulations * each.share)) for each in planned}
    left = sum(max(0, goals[name] - tally.done) for name, tally in tallies.items())
    with tqdm(total=left, unit="study", smoothing=0.02) as bar:
        # a little of every experiment in turn: the time left is then that of all of them
        for part in range(1, PARTS + 1):
            for each in planned:
                tally, before = tallies[each.name], tallies[each.name].done
                until = round(goals[each.name] * part / PARTS)
                simulate(tally, each.name, each.draw, each.judge, until, asked.seed)
                bar.update(tally.done - before)
            write(asked.out, asked.seed, tallies)
    print(markdown(table(tallies)))


if __name__ == "__main__":
    main()
