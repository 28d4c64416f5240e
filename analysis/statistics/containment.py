"""How many observations stand against a fixed effect of a mixed model: containment degrees of freedom."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy import sparse

from analysis.statistics.design_matrix import Coding
from analysis.statistics.undefined import Floats

Codes = npt.NDArray[np.int64]
CONSTANT = 1e-9  # what float64 leaves of a column less its mean, which is of the size of 1


def denominators(coding: Coding, fixed: Floats, random: Sequence[Codes]) -> list[int]:
    """Denominator degrees of freedom of each term's F test, at least 1.

    A random term contains an effect whose columns are the same in all ratings of each of its labels, as pictures
    contain the factors they were made by. The effect then has what the random term adds to the rank of the fixed
    effects (the fewest, of several such terms: pictures - cells); an effect that no term contains has the ratings less
    the rank of all effects: (people - 1)(levels - 1) of one complete row. Agrees with SAS `ddfm = contain` and R
    `nlme::lme` where all ratings are there. Pinheiro & Bates (2000), Mixed-Effects Models, 2.4.2.

    `fixed`: ratings x effects, the intercept first; `random`: whose each rating is, from 0, of each term, also of one
    whose variance is estimated as 0: that few pictures look alike makes them no more.
    """
    inside = [within(fixed, codes) for codes in random]
    found = []
    for term in coding.terms:
        columns = slice(term.columns.start + 1, term.columns.stop + 1)
        added = [
            len(np.unique(codes)) + rank(part.T @ part) - fixed.shape[1]
            for codes, part in zip(random, inside, strict=True)
            if np.abs(part[:, columns]).max() < CONSTANT
        ]
        found.append(max(1, min(added, default=len(fixed) - rank_of_all(fixed, random, inside))))
    return found


def within(fixed: Floats, codes: Codes) -> Floats:
    """The columns less their mean over each label's ratings."""
    counts = np.bincount(codes).astype(float)
    means = np.stack([np.bincount(codes, column) / counts for column in fixed.T], axis=1)
    return np.asarray(fixed - means[codes], dtype=np.float64)


def rank_of_all(fixed: Floats, random: Sequence[Codes], inside: Sequence[Floats]) -> int:
    """The rank of fixed and random effects side by side."""
    if len(random) == 1:
        return int(random[0].max()) + 1 + rank(inside[0].T @ inside[0])
    ones = np.ones(len(fixed))
    labels = [sparse.csr_array((ones, (np.arange(len(fixed)), codes))) for codes in random]
    whole = sparse.hstack([sparse.csr_array(fixed), *labels], format="csr")
    return rank((whole.T @ whole).toarray())


def rank(gram: Floats) -> int:
    """The rank of a matrix from its products."""
    size = np.sqrt(np.diag(gram))
    size[size < CONSTANT] = 1.0
    return int(np.linalg.matrix_rank(gram / np.outer(size, size), tol=CONSTANT, hermitian=True))
