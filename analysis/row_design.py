"""A row of the report as places among the pictures: its tests for thousands of simulated studies at once."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg import helmert

from analysis.labels import natural_order
from analysis.plan import BEST, AnalysisPlan, Mode
from analysis.rows import Level, Row, declared
from analysis.statistics.batches import (
    Moments,
    independent_p,
    paired_equivalence_p,
    repeated_p,
    welch_equivalence_p,
)
from analysis.statistics.undefined import Floats
from analysis.study import StudyInfo

Places = npt.NDArray[np.intp]


@dataclass(frozen=True)
class RowDesign:
    """Which pictures make the samples of a row.

    `places`: of each sample's pictures, in the manifest's order; `shares`: their weights in a person's mean. `means`:
    expected answer of each sample; `plain_means`: with pictures that weigh alike, as tests of equivalence have them.
    `best`: which sample is the own picture with the highest mean, picked anew in each study from `own`; None if none
    is. `pictures`: how many there are in all.
    """

    row: Row
    mode: Mode
    places: tuple[tuple[int, ...], ...]
    shares: tuple[tuple[float, ...], ...]
    means: tuple[float, ...]
    plain_means: tuple[float, ...]
    best: int | None
    own: tuple[int, ...]
    pictures: int

    @classmethod
    def of(cls, row: Row, study: StudyInfo, plan: AnalysisPlan, mode: Mode, means: Mapping[str, float]) -> "RowDesign":
        """The design of `row`. `means`: stimulus id -> expected answer to its question."""
        place = {picture.id: index for index, picture in enumerate(study.pictures)}
        compared = {(each.name, each.question): each for each in declared(study, plan, [row.question], set(means))}
        stimuli = compared[row.name, row.question].stimuli if row.kind == "comparison" else ()
        own = [picture.id for picture in study.pictures if picture.role == "factor"]
        plain = [{name: 1 / len(level.stimuli) for name in level.stimuli} for level in row.levels]
        weights = [shares(row, level) for level in row.levels] if mode == "repeated" else plain
        return cls(
            row=row,
            mode=mode,
            places=tuple(tuple(place[stimulus] for stimulus in level.stimuli) for level in row.levels),
            shares=tuple(tuple(of_sample.values()) for of_sample in weights),
            means=tuple(weighted(means, of_sample) for of_sample in weights),
            plain_means=tuple(weighted(means, of_sample) for of_sample in plain),
            best=stimuli.index(BEST) if BEST in stimuli else None,
            own=tuple(place[str(name)] for name in natural_order(own)),
            pictures=len(study.pictures),
        )

    def expected_difference(self) -> float:
        """The largest between expected means; of an interaction, its largest departure from a sum of effects."""
        means = np.array(self.means)
        if self.row.kind != "interaction":
            return float(np.ptp(means))
        contrasts = self.interaction()
        return float(np.abs(contrasts @ (contrasts.T @ means)).max())

    def interaction(self) -> Floats:
        """Orthonormal contrasts of an interaction: combinations of levels x df1."""
        matrix: Any = np.ones((1, 1))
        for levels in zip(*(level.value for level in self.row.levels), strict=True):
            matrix = np.kron(matrix, helmert(len(dict.fromkeys(map(str, levels)))).T)
        return np.asarray(matrix, dtype=np.float64)

    def difference_p(self, pictures: Moments) -> Floats:
        """p of the analysis of variance in each study; NaN where the report would leave it out."""
        if self.mode == "repeated":
            contrasts = self.interaction() if self.row.kind == "interaction" else None
            return self.left_out(pictures, repeated_p(self.samples(pictures), contrasts))
        if self.best is None:
            return independent_p(pictures, self.places)
        return self.left_out(pictures, independent_p(self.samples(pictures), self.alone))

    def equivalence_p(self, pair: tuple[int, int], margin: float, pictures: Moments) -> Floats:
        """p of the equivalence of two samples in each study, whose pictures weigh alike (`margins.judge_row`)."""
        compared, places = pictures, self.places
        if self.best is not None:
            compared, places = self.samples(pictures), self.alone
        a, b = (places[index] for index in pair)
        if self.mode == "independent":
            return self.left_out(pictures, welch_equivalence_p(compared, a, b, margin))
        weights = columns((a, b), [(1 / len(each),) * len(each) for each in (a, b)], compared.mean.shape[1])
        return self.left_out(pictures, paired_equivalence_p(compared.combined(weights), margin))

    @property
    def alone(self) -> tuple[tuple[int, ...], ...]:
        """Places among the samples, each by itself."""
        return tuple((index,) for index in range(len(self.places)))

    def samples(self, pictures: Moments) -> Moments:
        """Of the row's samples; of several pictures each person's mean."""
        if self.best is not None:
            return pictures.chosen(self.picked(pictures))
        return pictures.combined(columns(self.places, self.shares, self.pictures))

    def picked(self, pictures: Moments) -> Places:
        """(studies, samples): the pictures compared; of equal means the first in natural order is the best."""
        own = np.array(self.own)
        # totals of answers are whole numbers, so rounding makes equal ones equal
        totals = np.round(pictures.mean[:, own] * pictures.people, 6)
        samples = np.tile([places[0] for places in self.places], (len(totals), 1))
        samples[:, self.best] = own[np.argmax(totals, axis=1)]
        return samples

    def left_out(self, pictures: Moments, p: Floats) -> Floats:
        """NaN in place of `p` where the best picture is also one of those named: the comparison is then not made."""
        if self.best is None:
            return p
        samples = self.picked(pictures)
        named = np.delete(samples, self.best, axis=1)
        return np.where((named == samples[:, [self.best]]).any(axis=1), np.nan, p)


def columns(places: Sequence[Sequence[int]], weights: Sequence[Sequence[float]], pictures: int) -> Floats:
    """pictures x samples: the weights of the pictures at `places` of each sample, 0 elsewhere."""
    matrix = np.zeros((pictures, len(places)))
    for sample, mine in enumerate(places):
        matrix[list(mine), sample] = weights[sample]
    return matrix


def weighted(means: Mapping[str, float], weights: Mapping[str, float]) -> float:
    """The weighted sum of pictures' means."""
    return sum(weight * means[name] for name, weight in weights.items())


def shares(row: Row, level: Level) -> dict[str, float]:
    """Stimulus -> its weight in a person's mean of the sample; combinations of levels in a factorial weigh alike."""
    crossed = {} if row.crossed is None else dict(row.crossed.cells)
    cell = {name: crossed.get(name, (name,)) for name in level.stimuli}
    count = Counter(cell.values())
    return {name: 1 / (len(count) * count[cell[name]]) for name in level.stimuli}
