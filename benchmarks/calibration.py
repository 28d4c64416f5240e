"""Do the tests reject as often as they say, and do the intervals cover? `python -m benchmarks.calibration`.

Writes calibration.json beside it, the table of docs/calibration.md, and the rates in that page's words; prints the
sentences that the table no longer bears out, which a person then rewrites, and returns 1 if there are any.

What is drawn depends on the seed, the experiment's name and the number of the draw alone, so a run that was stopped is
taken up where calibration.json ends; not if a statistic or a library that it calls has changed since.
"""

import argparse
import ast
import hashlib
import json
import zlib
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from analysis.statistics.undefined import Floats, Undefined
from benchmarks import calibration_page as page
from benchmarks.calibration_experiments import Experiment, Says, experiments

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "benchmarks" / "calibration.json"
SOURCES = ("analysis/statistics/*.py", "benchmarks/calibration_*.py")
LIBRARIES = ("numpy", "scipy", "statsmodels", "pingouin", "krippendorff")
SEED, PARTS = 2011, 20


@dataclass
class Tally:
    """What one experiment has said so far: how often each claim held, of how many studies; `silent`: no value."""

    done: int = 0
    silent: int = 0
    hits: Counter[str] = field(default_factory=Counter)

    def add(self, said: Says | None, studies: int = 1) -> None:
        """As many studies more; None where a statistic had no value. A study with one NaN counts for no claim."""
        self.done += studies
        if said is None:
            self.silent += studies
            return
        held: Floats = np.array([np.broadcast_to(np.asarray(each, np.float64), studies) for each in said.values()])
        spoke = ~np.isnan(held).any(axis=0)
        self.silent += studies - int(spoke.sum())
        self.hits.update({claim: int(row[spoke].sum()) for claim, row in zip(said, held, strict=True)})


def simulate(tally: Tally, each: Experiment, until: int, seed: int) -> None:
    """Studies number `tally.done` to `until` of an experiment, both multiples of its `at_once`."""
    for number in range(tally.done // each.at_once, until // each.at_once):
        drawn = each.draw(np.random.default_rng([seed, zlib.crc32(each.name.encode()), number]))
        try:
            tally.add(each.judge(drawn), each.at_once)
        except Undefined:
            tally.add(None, each.at_once)


def fingerprint() -> str:
    """Of what the rates depend on: the statistics' and the study's source, less comments and docstrings, and libraries.

    calibration_page.py only shows them.
    """
    digest = hashlib.sha256(" ".join(f"{name} {version(name)}" for name in LIBRARIES).encode())
    for path in sorted(path for pattern in SOURCES for path in ROOT.glob(pattern)):
        if path.stem != "calibration_page":
            digest.update(path.relative_to(ROOT).as_posix().encode() + code_of(path.read_text(encoding="utf-8")))
    return digest.hexdigest()


def code_of(source: str) -> bytes:
    """A module's syntax without comments, layout and docstrings."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node) is not None:
            node.body = node.body[1:] or [ast.Pass()]
    return ast.dump(tree).encode()


def read(path: Path, seed: int, of: str | None = None) -> dict[str, Tally]:
    """What an earlier run of the same seed has found; nothing where there was none, or of another fingerprint `of`."""
    earlier: dict[str, Any] = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    if earlier.get("seed") != seed or of not in (None, earlier.get("statistics")):
        return {}
    return {
        name: Tally(entry["studies"], entry["without_value"], Counter(entry["hits"]))
        for name, entry in earlier["experiments"].items()
    }


def write(path: Path, seed: int, of: str, tallies: Mapping[str, Tally]) -> None:
    """All tallies, to be taken up again."""
    entries = {
        name: {"studies": tally.done, "without_value": tally.silent, "hits": dict(tally.hits)}
        for name, tally in tallies.items()
    }
    kept = {"seed": seed, "statistics": of, "experiments": entries}
    path.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def counts_of(tallies: Mapping[str, Tally]) -> list[page.Count]:
    """Every claim of every experiment that has one."""
    return [
        page.Count(claim, name.rsplit(": ", 1)[-1], hits, tally.done - tally.silent)
        for name, tally in tallies.items()
        for claim, hits in tally.hits.items()
        if tally.done > tally.silent
    ]


def run(out: Path, seed: int, share: float) -> dict[str, Tally]:
    """Every experiment to that share of its studies, saved as it goes."""
    planned, of = experiments(), fingerprint()
    earlier = read(out, seed, of)
    tallies = {each.name: earlier.get(each.name, Tally()) for each in planned}
    for part in tqdm(range(1, PARTS + 1), unit="part", desc="calibration", dynamic_ncols=True):
        # a little of every experiment in turn: the time left is then that of all of them
        for each in planned:
            draws = max(1, round(share * each.studies / each.at_once))
            simulate(tallies[each.name], each, round(draws * part / PARTS) * each.at_once, seed)
        write(out, seed, of, tallies)
    return tallies


def main() -> int:
    """Simulate, save, show; 1 where the page's words no longer fit."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--share", type=float, default=1.0, help="of the studies of a full run, above 0")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--out", type=Path, default=RESULTS)
    parser.add_argument("--page", type=Path, default=page.PAGE)
    asked = parser.parse_args()
    counts = counts_of(run(asked.out, asked.seed, asked.share))
    text, unfit = page.updated(asked.page.read_text(encoding="utf-8"), counts)
    asked.page.write_text(text, encoding="utf-8")
    print("\n".join(unfit) or f"every rate in the words of {asked.page.name} is the table's, and its verdict too")
    return 1 if unfit else 0


if __name__ == "__main__":
    raise SystemExit(main())
