"""What the calibration study draws and judges: people without (or with known) effects, and what each statistic says.

    answer = mean of the picture + person + noise, on a rating scale rounded and clipped to 1..7

as study_server/simulation/raters.py answers, with its spreads. The statistics
here are the public objects, called as the report calls them; those quick enough for thousands of studies are judged by
calibration_batches.py.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd
from scipy import stats

from analysis.statistics.agreement import IntraclassCorrelation, KrippendorffAlpha
from analysis.statistics.anova import OneWayAnova, RepeatedMeasuresAnova
from analysis.statistics.cues import CueRegression, CueSlopes
from analysis.statistics.mixed import MixedModel
from analysis.statistics.ordinal import OrdinalRegression
from analysis.statistics.undefined import Floats
from analysis.statistics.wilcoxon import SignedRanks
from benchmarks.calibration_batches import ALPHA

STEPS = 7
PERSON_SD, NOISE_SD = 0.7, 0.9  # study_server.simulation.raters.Effects
PICTURE_SD = 1.0
BETWEEN = {"value": "rating", "group": "condition"}
WITHIN = {"value": "rating", "within": "condition", "subject": "participant"}
UNEQUAL = (0.4, 0.4, 0.4, 2.0)  # one picture divides people: epsilon .405, sphericity is far off


@dataclass(frozen=True)
class Crowd:
    """`people` who rate pictures of the given latent `means` (for each picture, where `independent`).

    `noises`: standard deviations of the noise, one a picture. `steps`: 1..7 are answered; else the latent value itself.
    """

    name: str
    people: int
    means: tuple[float, ...]
    steps: bool = False
    noises: tuple[float, ...] | None = None
    independent: bool = False

    def answers(self, random: np.random.Generator, studies: int) -> Floats:
        """(people, studies, pictures)."""
        n, k = self.people, len(self.means)
        person = PERSON_SD * random.standard_normal((n, studies, k if self.independent else 1))
        noise = np.array(self.noises or (NOISE_SD,)) * random.standard_normal((n, studies, k))
        latent = np.array(self.means) + person + noise
        return np.clip(np.rint(latent), 1, STEPS) if self.steps else latent

    def frame(self, random: np.random.Generator) -> pd.DataFrame:
        """One study: `participant, condition, rating`."""
        return self.long(self.answers(random, 1)[:, 0])

    def long(self, rating: Floats) -> pd.DataFrame:
        """Answers of one study (people, pictures) as rows `participant, condition, rating`."""
        n, k = rating.shape
        who = np.arange(n * k) if self.independent else np.repeat(np.arange(n), k)
        condition = np.tile([f"M{place}" for place in range(1, k + 1)], n)
        return pd.DataFrame({"participant": who, "condition": condition, "rating": rating.ravel()})

    @cached_property
    def truth(self) -> Floats:
        """The population mean of each picture's ratings."""
        spread = np.hypot(PERSON_SD, np.broadcast_to(self.noises or NOISE_SD, len(self.means)))
        return expected(np.array(self.means), spread) if self.steps else np.array(self.means)


def expected(mean: Floats, spread: Floats | float) -> Floats:
    """Mean answer on 1..7 where the latent answer is normal: 1 + the probabilities of at least 2, 3, ..., 7."""
    edges = np.arange(1, STEPS) + 0.5
    return np.asarray(1 + stats.norm.sf((edges - mean[:, None]) / np.broadcast_to(spread, mean.shape)[:, None]).sum(1))


def effect_size_between(frame: pd.DataFrame, crowd: Crowd) -> dict[str, bool]:
    """Independent samples of unlike means."""
    effect = float(np.var(crowd.truth))
    truth = effect / (effect + PERSON_SD**2 + NOISE_SD**2)
    return {"90% CI of eta squared": covers(OneWayAnova(**BETWEEN)(frame).iloc[0], truth)}


def effect_sizes_within(frame: pd.DataFrame, crowd: Crowd) -> dict[str, bool]:
    """The same people, pictures of unlike means; the error's mean square is the mean of their noise's variances."""
    anova = RepeatedMeasuresAnova(**WITHIN)(frame).iloc[0]
    k, squares = len(crowd.truth), float(((crowd.truth - crowd.truth.mean()) ** 2).sum())
    noise = float(np.mean(np.square(crowd.noises or NOISE_SD)))
    partial_eta = squares / (squares + (k - 1) * noise)
    general = squares / (squares + k * PERSON_SD**2 + k * noise)
    return {
        "90% CI of partial eta squared": anova["partial_ci_low"] <= partial_eta <= anova["partial_ci_high"],
        "90% CI of generalized eta squared": covers(anova, general),
    }


def models(frame: pd.DataFrame) -> dict[str, bool]:
    """The tests of the two models; every level is one picture, so the mixed model has people's variance alone."""
    found = {"mixed model, F with containment df": MixedModel("rating", ("condition",), "participant", None)(frame)}
    if frame["rating"].nunique() <= STEPS:
        claim = "ordinal regression, clustered by person, Hotelling's F"
        found[claim] = OrdinalRegression("rating", ("condition",), "participant")(frame)
    return {claim: table["p"].iloc[0] < ALPHA for claim, table in found.items()}


def random_pictures(random: np.random.Generator, people: int, pictures: int, spread: float) -> pd.DataFrame:
    """Three levels of equal mean, each shown by `pictures` pictures that differ by `spread` steps for other reasons."""
    means = 4 + spread * random.standard_normal(3 * pictures)
    frame = Crowd("", people, tuple(means), steps=True).frame(random)
    place = frame["condition"].str[1:].astype(int) - 1
    return frame.rename(columns={"condition": "picture"}).assign(condition=place // pictures)


def picture_models(frame: pd.DataFrame) -> dict[str, bool]:
    """Is a level's effect claimed for pictures at large? The analysis of means knows these pictures only."""
    cells = frame.groupby(["participant", "condition"], as_index=False)["rating"].mean()
    mixed = MixedModel("rating", ("condition",), "participant", "picture")(frame)
    return {
        "mixed model, F with containment df": mixed["p"].iloc[0] < ALPHA,
        "repeated-measures F, Greenhouse-Geisser": RepeatedMeasuresAnova(**WITHIN)(cells)["p_gg"].iloc[0] < ALPHA,
    }


def two_alike(frame: pd.DataFrame) -> dict[str, bool]:
    """Two pictures of one mean."""
    return {"Wilcoxon, signed ranks": SignedRanks(**WITHIN)(frame)["p"].iloc[0] < ALPHA}


def random_cues(random: np.random.Generator, people: int, pictures: int) -> pd.DataFrame:
    """Pictures of unlike means with three cues, `a, b, c`, drawn without regard to them."""
    means = 4 + PICTURE_SD * random.standard_normal(pictures)
    frame = Crowd("", people, tuple(means), steps=True).frame(random)
    cues = pd.DataFrame(random.standard_normal((pictures, 3)), columns=["a", "b", "c"])
    return pd.concat([frame, cues.iloc[np.tile(np.arange(pictures), people)].reset_index(drop=True)], axis=1)


def cues_of_chance(frame: pd.DataFrame) -> dict[str, bool]:
    """Is a cue found that has nothing to do with the ratings?"""
    columns = ("rating", "participant", "condition")
    alone = CueSlopes(*columns, ("a",))(frame).iloc[0]
    together = CueRegression(*columns, ("a", "b", "c"))(frame).iloc[0]
    return {
        "a cue drawn at random, r with the pictures' means": alone["p_pictures"] < ALPHA,
        "a cue drawn at random, slopes of people": alone["p"] < ALPHA,
        "a cue drawn at random, regression clustered by person": together["p"] < ALPHA,
    }


@dataclass(frozen=True)
class Gallery:
    """`people` who rate pictures drawn at random from all, whose latent means spread by `PICTURE_SD` about 4."""

    name: str
    people: int
    pictures: int
    steps: bool

    def table(self, random: np.random.Generator, pictures: int) -> Floats:
        """People x pictures."""
        means = 4 + PICTURE_SD * random.standard_normal(pictures)
        person = PERSON_SD * random.standard_normal((self.people, 1))
        latent = means + person + NOISE_SD * random.standard_normal((self.people, pictures))
        return np.clip(np.rint(latent), 1, STEPS) if self.steps else latent

    def frame(self, random: np.random.Generator) -> pd.DataFrame:
        """One study: `participant, condition` (the picture), `rating`."""
        who, what = np.indices((self.people, self.pictures))
        ratings = self.table(random, self.pictures).ravel()
        return pd.DataFrame({"participant": who.ravel(), "condition": what.ravel(), "rating": ratings})

    @cached_property
    def icc(self) -> float:
        """ICC(A,1): the share of a rating's variance that is the picture's, of rounded answers by quadrature."""
        if not self.steps:
            return PICTURE_SD**2 / (PICTURE_SD**2 + PERSON_SD**2 + NOISE_SD**2)
        nodes, weights = np.polynomial.hermite_e.hermegauss(80)
        given = expected(4 + PICTURE_SD * nodes, np.hypot(PERSON_SD, NOISE_SD))
        between = float(np.average((given - 4) ** 2, weights=weights))
        edges = np.arange(1, STEPS) + 0.5
        above = stats.norm.sf((edges - 4) / np.sqrt(PICTURE_SD**2 + PERSON_SD**2 + NOISE_SD**2))
        squares = 1 + float((above * (2 * np.arange(2, STEPS + 1) - 1)).sum())  # E x^2 = sum of (2r - 1) P(x >= r)
        return between / (squares - 16)

    @cached_property
    def alpha(self) -> float:
        """Krippendorff's ordinal alpha of 400 people and 2000 pictures."""
        many = replace(self, people=400, pictures=2000).frame(np.random.default_rng(2011))
        return float(KrippendorffAlpha("rating", "condition", "participant", resamples=1)(many)["alpha"].iloc[0])


def agreement(frame: pd.DataFrame, gallery: Gallery) -> dict[str, bool]:
    """Both coefficients of agreement, as the report computes them."""
    icc = IntraclassCorrelation("rating", "condition", "participant")(frame).set_index("type").loc["ICC(A,1)"]
    found = {"95% CI of ICC(A,1)": covers(icc, gallery.icc)}
    if gallery.steps:
        alpha = KrippendorffAlpha("rating", "condition", "participant")(frame).iloc[0]
        found["95% CI of Krippendorff's alpha, bootstrap"] = covers(alpha, gallery.alpha)
    return found


def covers(row: "pd.Series[float]", truth: float) -> bool:
    """Whether `ci_low` to `ci_high` holds the truth."""
    return bool(row["ci_low"] <= truth <= row["ci_high"])
