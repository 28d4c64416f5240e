"""A report on a million ratings beside what its libraries need alone: `python benchmarks/million_ratings.py`.

2,000 people rate 500 pictures on one question, in the columns of the survey's export. Two studies: a full factorial of
5 x 10 x 10 with its manifest and pictures, and the same ratings without a manifest, where every picture is compared
with every other (124,750 pairs). Each part runs in a process of its own, whose peak of memory is its own too: *read* is
`pandas.read_csv` of the columns that the report reads; *library* the libraries' own functions on arrays that lie ready,
called as thriftily as can be (each distinct q of Tukey's once, t tests by the column, proportional odds on counts);
*report* `write_report`. The figure to look at is report over read plus library, in processor seconds: those of other
programs do not count. On several cores a library may count more seconds than pass.
"""

import json
import resource
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from functools import cache
from itertools import combinations, product
from pathlib import Path
from typing import Any

import click
import krippendorff
import numpy as np
import numpy.typing as npt
import pandas as pd
import pingouin
from PIL import Image
from scipy import stats
from scipy.special import nctdtrinc
from statsmodels.regression.linear_model import OLS

from analysis import write_report
from analysis.columns import OPTIONAL, REQUIRED
from analysis.cue_findings import NAMES as CUE_NAMES
from analysis.statistics.proportional_odds import CountedOrderedModel
from study_server.exports.columns import RATINGS

FACTORS = {"thickness exponent": 5, "backlight": 10, "diffuse weight": 10}
SCALE = 7
SIDE = 64  # pixels of the stand-in pictures
STUDIES = ("factorial", "pictures")
CUES = tuple(CUE_NAMES)
SHA = "0123456789abcdef" * 4
Floats = npt.NDArray[np.float64]


def latent_ratings(people: int) -> Floats:
    """People x 500 pictures, 1..7: a picture's worth from its levels, a person's leaning, and noise."""
    random = np.random.default_rng(2011)
    levels = np.array(list(product(*(np.linspace(-1, 1, n) for n in FACTORS.values()))))
    worth = levels @ [0.8, 0.4, 0.0] + random.normal(0, 0.2, len(levels))
    leaning = random.normal(0, 0.7, (people, 1))
    answers = np.round(4 + worth + leaning + random.normal(0, 1.2, (people, len(levels))))
    return np.clip(answers, 1, SCALE)


def identities() -> list[str]:
    """Ids of the pictures, as the build numbers them."""
    return [f"img{number:03d}" for number in range(1, int(np.prod(list(FACTORS.values()))) + 1)]


def write_csv(path: Path, people: int) -> None:
    """All columns of the export; each person's pictures in an order of their own."""
    wide, names = latent_ratings(people), np.array(identities())
    random = np.random.default_rng(4)
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8") as file:
        file.write(",".join(RATINGS) + "\n")
        for who in range(people):
            order = random.permutation(len(names))
            rt = random.integers(700, 9000, len(names))
            for trial, picture in enumerate(order, 1):
                at = f"2026-03-{1 + who % 28:02d}T{10 + trial // 60 % 10:02d}:{trial % 60:02d}"
                cells = {
                    "session": f"s{who:06d}",
                    "participant": f"p{who:06d}",
                    "mode": "live",
                    "started_at": f"2026-03-{1 + who % 28:02d}T09:{who // 28 % 60:02d}:00.000Z",
                    "trial": trial,
                    "presentation": 1,
                    "stimulus": names[picture],
                    "question": "translucent",
                    "rating": int(wide[who, picture]),
                    "rt_ms": rt[trial - 1],
                    "shown_at": f"{at}:00.000Z",
                    "answered_at": f"{at}:04.{rt[trial - 1] % 1000:03d}Z",
                    "revision": 0,
                    "device_pixel_ratio": 1,
                    "zoom": 1,
                    "drawn_width_px": 512,
                    "window_width_px": 1440,
                    "window_height_px": 900,
                    "focus_lost_ms": 0,
                    "study_sha256": SHA,
                    "stimulus_sha256": SHA[::-1],
                }
                file.write(",".join(str(cells.get(name, "")) for name in RATINGS) + "\n")


def write_study(path: Path) -> None:
    """The manifest of the full factorial, with a picture of noise for each combination."""
    path.parent.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng(7)
    combos = product(*(range(n) for n in FACTORS.values()))
    stimuli: list[dict[str, Any]] = []
    for identity, levels in zip(identities(), combos, strict=True):
        coarse = random.integers(0, 256, (8, 8, 3), dtype=np.uint8)
        picture = Image.fromarray(coarse).resize((SIDE, SIDE), Image.Resampling.BICUBIC)
        picture.save(path.parent / f"{identity}.png")
        named = dict(zip(FACTORS, levels, strict=True))
        label = ", ".join(f"{name} {level}" for name, level in named.items())
        entry = {"id": identity, "file": f"{identity}.png", "factors": named, "rows": list(FACTORS)}
        cues = {name: round(float(random.normal()), 6) for name in CUES}
        stimuli.append({**entry, "same_picture_as": None, "role": "factor", "label": label, "cues": cues})
    study = {
        "title": "A million ratings",
        "seed": 1,
        "sha256": SHA,
        "design": {"kind": "full-factorial"},
        "factors": [{"name": name, "path": "material.x", "levels": list(range(n))} for name, n in FACTORS.items()],
        "question": [
            {"name": "translucent", "text": "It looks translucent.", "scale": SCALE, "low": "no", "high": "yes"}
        ],
        "analysis": {},
    }
    path.write_text(json.dumps({"format": 1, "study": study, "stimuli": stimuli}), encoding="utf-8")


def read(folder: Path) -> dict[str, float]:
    """Seconds of plain reading."""
    return timed(read=lambda: pd.read_csv(folder / "ratings.csv", usecols=[*REQUIRED, *OPTIONAL]))


def library(folder: Path, study: str) -> dict[str, float]:
    """Seconds of each library call that the report makes, on arrays that lie ready."""
    wide = np.load(folder / "wide.npy")
    return calls_of_factorial(wide) if study == "factorial" else calls_of_pictures(wide)


def calls_of_factorial(wide: Floats) -> dict[str, float]:
    """Every main effect, the simple effects of the interactions, then what looks at single answers."""
    shaped = wide.reshape(len(wide), *FACTORS.values())
    seconds: dict[str, float] = {}
    for axis in range(1, shaped.ndim):
        others = tuple(other for other in range(1, shaped.ndim) if other != axis)
        for name, value in calls_of(shaped.mean(axis=others)).items():
            seconds[name] = seconds.get(name, 0.0) + value
    seconds |= timed(simple_effects=lambda: simple_effects(shaped))
    return seconds | calls_of_agreement(wide) | calls_of_models(wide) | calls_of_cues(wide)


def calls_of_cues(wide: Floats) -> dict[str, float]:
    """Least squares of all ratings on the cues, with errors clustered by person."""
    cues = np.random.default_rng(7).normal(size=(wide.shape[1], len(CUES)))
    design = np.column_stack([np.ones(wide.size), np.tile(cues, (len(wide), 1))])
    fit = OLS(wide.ravel(), design)
    people = np.repeat(np.arange(len(wide)), wide.shape[1])
    return timed(cues=lambda: fit.fit(cov_type="cluster", cov_kwds={"groups": people}, use_t=True))


def simple_effects(shaped: Floats) -> None:
    """Each factor's analysis of variance at every combination of others' levels, in each interaction."""
    places = range(1, shaped.ndim)
    for order in range(2, shaped.ndim):
        for axes in combinations(places, order):
            whole = shaped.mean(axis=tuple(axis for axis in places if axis not in axes))
            for axis in range(1, whole.ndim):
                parts = np.moveaxis(whole, axis, -1).reshape(len(whole), -1, whole.shape[axis])
                for part in range(parts.shape[1]):
                    pingouin.rm_anova(pd.DataFrame(parts[:, part]), detailed=True)


def calls_of_pictures(wide: Floats) -> dict[str, float]:
    """500 samples compared with one another, then what looks at single answers."""
    return calls_of(wide) | calls_of_agreement(wide) | calls_of_models(wide)


def calls_of_models(wide: Floats) -> dict[str, float]:
    """Proportional odds of 499 differences, on how often each answer was given to each picture."""
    counts = np.array([np.bincount(column.astype(int), minlength=SCALE + 1)[1:] for column in wide.T])
    picture, answer = np.nonzero(counts)
    dummies = np.eye(len(counts))[picture][:, 1:]
    odds = CountedOrderedModel(answer, dummies, counts[picture, answer].astype(float))
    return timed(ordinal=lambda: odds.fit(method="newton", disp=0))


def calls_of(wide: Floats) -> dict[str, float]:
    """Analyses of variance, ranks, Tukey's q (each distinct one once) and t tests of all pairs; people x samples."""
    k, n = wide.shape[1], len(wide)
    long = pd.DataFrame(wide).rename_axis("who").reset_index().melt("who", var_name="sample", value_name="rating")
    pairs = list(combinations(range(k), 2))
    means = wide.mean(axis=0)
    left = wide - wide.mean(axis=1, keepdims=True) - means + wide.mean()
    df = (k - 1) * (n - 1)
    error = np.sqrt((left**2).sum() / df / n)
    t = np.concatenate([stats.ttest_rel(wide[:, [a]], wide[:, a + 1 :]).statistic for a in range(k - 1)])
    q = np.unique(np.round([abs(means[a] - means[b]) / error for a, b in pairs], 9))
    return timed(
        rm_anova=lambda: pingouin.rm_anova(long, dv="rating", within="sample", subject="who", detailed=True),
        f_oneway=lambda: stats.f_oneway(*wide.T),
        friedman=lambda: stats.friedmanchisquare(*wide.T),
        tukey=lambda: [stats.studentized_range.sf(each, k, degrees) for degrees in (df, k * (n - 1)) for each in q],
        hsd=lambda: [quantile(level, k, degrees) for degrees in (df, k * (n - 1)) for level in (0.95, 0.99)],
        t_tests=lambda: [stats.ttest_rel(wide[:, [a]], wide[:, a + 1 :]).confidence_interval() for a in range(k - 1)],
        d_z=lambda: [nctdtrinc(n - 1, tail, np.clip(t, -1000, 1000)) for tail in (0.025, 0.975)],
    )


@cache
def quantile(level: float, k: int, df: float) -> float:
    """Of the studentized range, once for rows of one size."""
    return float(stats.studentized_range.ppf(level, k, df))


def calls_of_agreement(wide: Floats, resamples: int = 1000) -> dict[str, float]:
    """Intraclass correlations; Krippendorff's alpha and its bootstrap from counts of each answer a picture."""
    long = pd.DataFrame(wide).rename_axis("who").reset_index().melt("who", var_name="sample", value_name="rating")
    counts = np.array([np.bincount(column.astype(int), minlength=SCALE + 1)[1:] for column in wide.T])
    values = np.arange(1.0, SCALE + 1)
    draws = np.random.default_rng(0).integers(0, len(counts), (resamples, len(counts)))

    def alpha(table: npt.NDArray[np.int64]) -> float:
        return float(krippendorff.alpha(value_counts=table, value_domain=values, level_of_measurement="ordinal"))

    return timed(
        icc=lambda: pingouin.intraclass_corr(long, targets="sample", raters="who", ratings="rating"),
        alpha=lambda: [alpha(counts), *(alpha(counts[draw]) for draw in draws)],
    )


def report(folder: Path, study: str) -> dict[str, float]:
    """Seconds of the whole report."""
    manifest = folder / "stimuli" / "manifest.json" if study == "factorial" else None
    return timed(report=lambda: write_report(folder / "ratings.csv", folder / f"report-{study}", manifest=manifest))


def timed(**calls: Callable[[], object]) -> dict[str, float]:
    """Processor seconds of each: other programs hardly disturb them."""
    seconds = {}
    for name, call in calls.items():
        start = time.process_time()
        call()
        seconds[name] = time.process_time() - start
    return seconds


def alone(folder: Path, part: str, study: str) -> tuple[dict[str, float], float]:
    """A part in a fresh process: its seconds and its peak of memory, MiB."""
    command = [sys.executable, __file__, "--folder", str(folder), "--part", part, "--study", study]
    said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    answer = json.loads(said.splitlines()[-1])
    return answer["seconds"], answer["mib"]


def run_part(folder: Path, part: str, study: str) -> None:
    """What the fresh process does; its last line is JSON."""
    warnings.simplefilter("ignore")
    parts = {"read": lambda: read(folder), "library": lambda: library(folder, study)}
    parts |= {"report": lambda: report(folder, study)}
    seconds = parts[part]()
    click.echo(json.dumps({"seconds": seconds, "mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))


@click.command()
@click.option("--folder", type=click.Path(path_type=Path), default=Path("million"), show_default=True)
@click.option("--people", default=2000, show_default=True)
@click.option("--part", type=click.Choice(["read", "library", "report"]), hidden=True)
@click.option("--study", type=click.Choice(STUDIES), default="factorial", hidden=True)
def main(folder: Path, people: int, part: str | None, study: str) -> None:
    """Writes the studies into FOLDER where they are not yet, and prints seconds, ratio and memory of each part."""
    if part is not None:
        run_part(folder, part, study)
        return
    if not (folder / "ratings.csv").exists():
        write_csv(folder / "ratings.csv", people)
        write_study(folder / "stimuli" / "manifest.json")
        np.save(folder / "wide.npy", latent_ratings(people))
    for each in STUDIES:
        found = {name: alone(folder, name, each) for name in ("read", "library", "report")}
        seconds = {name: sum(times.values()) for name, (times, _) in found.items()}
        click.echo(f"{each}: report {seconds['report'] / (seconds['read'] + seconds['library']):.2f} of read + library")
        for name, (times, mib) in found.items():
            detail = ", ".join(f"{key} {value:.2f}" for key, value in times.items()) if len(times) > 1 else ""
            click.echo(f"  {name:8} {seconds[name]:7.1f} s  peak {mib:6.0f} MiB  {detail}")
        files = {path.name: path.stat().st_size / 1e6 for path in (folder / f"report-{each}").rglob("*.*")}
        large = sorted(files.items(), key=lambda entry: -entry[1])[:5]
        click.echo("  largest files: " + ", ".join(f"{name} {size:.1f} MB" for name, size in large))


if __name__ == "__main__":
    main()
