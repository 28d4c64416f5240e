"""How many people it takes to show that two pictures are rated alike."""

import math

from scipy import integrate, special, stats

from analysis.statistics.undefined import Floats

MOST_PEOPLE = 1_000_000
NODES = 200  # of Gauss and Legendre, over a smooth density


def equivalence_power(n: int, sd: float, margin: float, difference: float = 0.0, alpha: float = 0.05) -> float:
    """Probability, 0..1, that the paired TOST of `n` people calls two pictures equivalent.

    `sd`: of a person's difference between the two, > 0; `margin` and the true `difference` in the same steps; normal
    differences. Exact: over the distribution of the standard deviation that a study finds, the probability that the
    mean lies within the margin by t standard errors (Phillips 1990, J. Pharmacokinet. Biopharm. 18; the difference of
    two of Owen's Q). R's package PowerTOST computes the same for trials of bioequivalence.
    """
    df, root = n - 1, math.sqrt(n)
    critical = float(stats.t.isf(alpha, df))

    def inside(chi: Floats) -> Floats:
        room = margin - critical * sd * chi / math.sqrt(df) / root
        above, below = ((end - difference) * root / sd for end in (room, -room))
        density: Floats = (special.ndtr(above) - special.ndtr(below)) * stats.chi.pdf(chi, df)
        return density

    widest = margin * root * math.sqrt(df) / (critical * sd)  # beyond it no mean is near enough
    low, high = (float(stats.chi.ppf(tail, df)) for tail in (1e-12, 1 - 1e-12))
    if widest <= low:
        return 0.0
    return float(integrate.fixed_quad(inside, low, min(high, widest), n=NODES)[0])


def people_for_equivalence(sd: float, margin: float, power: float = 0.80, alpha: float = 0.05) -> int | None:
    """The fewest people whose paired TOST has that power where the pictures are exactly alike; None above a million."""
    few, many = 1, 2
    while equivalence_power(many, sd, margin, alpha=alpha) < power:
        few, many = many, 2 * many
        if many > MOST_PEOPLE:
            return None
    while many - few > 1:
        middle = (few + many) // 2
        if equivalence_power(middle, sd, margin, alpha=alpha) < power:
            few = middle
        else:
            many = middle
    return many
