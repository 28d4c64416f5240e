"""Tukey's p against an independent evaluation of its double integral, printed tables and R; scipy's lost tail."""

import json
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.integrate import IntegrationWarning
from scipy.special import gammaln, ndtr

from analysis import TukeyHSD
from analysis.statistics.studentized_range import FEW, P_FLOOR, studentized_quantile, tail_probabilities
from analysis.wording import exact_p, thesis_p

DATA = Path(__file__).parents[1] / "data" / "statistics"
R = json.loads((DATA / "thesis_shaped_reference_R.json").read_text())
Floats = npt.NDArray[np.float64]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(160)
STEP, STEP_WEIGHTS = np.polynomial.legendre.leggauss(10)


def range_tail(x: Floats, k: int) -> Floats:
    """P(range of k normal values > x): k times the integral of phi(z) (Phi(z)^(k-1) - (Phi(z) - Phi(z - x))^(k-1))."""
    z = NODES * 9
    below, apart = ndtr(z), ndtr(z - x[:, None])
    with np.errstate(divide="ignore"):  # where the range cannot be so small its logarithm is -inf
        inside = -(below ** (k - 1)) * np.expm1((k - 1) * np.log1p(-np.minimum(apart / below, 1)))
    density = np.exp(-z * z / 2) / np.sqrt(2 * np.pi)
    return np.asarray(k * (9 * WEIGHTS * density * inside).sum(axis=1))


def double_integral(q: float, k: int, df: int) -> float:
    """P(Q > q) by the definition: `range_tail` at q s, averaged over s = chi / sqrt(df); no code of scipy's routine."""
    low = np.log(1e-12) if df < 10 else np.log(max(0.02, 1 - 8 / np.sqrt(df)))
    edges = np.linspace(low, np.log(1 + 9 / np.sqrt(df)), 121)
    half = np.diff(edges) / 2
    u = ((edges[1:] + edges[:-1]) / 2)[:, None] + half[:, None] * STEP
    s, weights = np.exp(u).ravel(), (half[:, None] * STEP_WEIGHTS).ravel()
    log_density = np.log(2) + df / 2 * np.log(df / 2) - gammaln(df / 2) + df * (np.log(s) - s * s / 2)
    return float((weights * np.exp(log_density) * range_tail(q * s, k)).sum())


@pytest.mark.parametrize("df", [1, 2, 5, 30, 129, 2000])
def test_the_independent_integral_is_students_t_for_two_means(df: int) -> None:
    """The oracle itself: its closed form."""
    for q in (0.5, 2.0, 5.0, 20.0):
        assert double_integral(q, 2, df) == pytest.approx(2 * stats.t.sf(q / np.sqrt(2), df), abs=2e-12)


@pytest.mark.parametrize("df", [1, 2, 3, 5, 10, 30, 86, 129, 2000])
@pytest.mark.parametrize("k", [2, 3, 4, 10, 100])
def test_p_within_1e_9(k: int, df: int) -> None:
    """Over the whole course of p."""
    q = np.array([0.5, 2.0, 3.5, 5.0, 8.0, 20.0])
    exact = np.maximum([double_integral(each, k, df) for each in q], P_FLOOR)
    assert tail_probabilities(q, k, df) == pytest.approx(exact, abs=1e-10)


@pytest.mark.parametrize(
    ("level", "k", "df", "printed"),
    [
        (0.95, 2, 1, 17.97),
        (0.95, 3, 1, 26.98),
        (0.99, 2, 10, 4.48),
        (0.95, 3, 10, 3.88),
        (0.99, 3, 10, 5.27),
        (0.95, 4, 20, 3.96),
        (0.95, 10, 60, 4.65),
        (0.99, 3, 60, 4.28),
        (0.95, 3, np.inf, 3.31),
        (0.99, 3, np.inf, 4.12),
    ],
)
def test_printed_tables(level: float, k: int, df: float, printed: float) -> None:
    """Harter (1960), as in every textbook."""
    assert round(studentized_quantile(level, k, df), 2) == printed


@pytest.mark.parametrize(("name", "df"), [("thesis_shaped_repeated_n44", 129), ("thesis_shaped_independent_n29", 112)])
def test_r_prints_the_same_p(name: str, df: int) -> None:
    """R's ptukey at its own HSD's scale, as it prints it: three digits; what R gives below 1e-10 is a bound here."""
    reference = R[name]["Adolfo vs Gascons"]
    n = {129: 44, 112: 29}[df]
    for sentence in reference["pairs"]:
        a, b, _, printed = re.search(r"M(\d) vs M(\d).*diff\|=([\d.]+), p_tukey=([\d.e-]+)", sentence).groups()  # type: ignore[union-attr]
        difference = abs(reference["means"][int(a) - 1] - reference["means"][int(b) - 1])
        q = difference / np.sqrt(reference["MSE"] / n)
        (p,) = tail_probabilities(np.array([q]), 4, df)
        assert p == pytest.approx(max(float(printed), P_FLOOR), rel=5e-3)


@pytest.mark.parametrize("df", [1, 2, 3])
@pytest.mark.parametrize("k", [2, 3, 10, 500])
def test_scipys_lost_tail_is_found(k: int, df: int) -> None:
    """scipy issue 17832: 0 at q = 1e4, where p is 1e-4 with one degree of freedom."""
    q = np.array([150.0, 1e3, 1e4, 1e5])
    exact = np.array([double_integral_far(each, k, df) for each in q])
    found = tail_probabilities(q, k, df)
    assert found == pytest.approx(np.maximum(exact, P_FLOOR), rel=1e-7)
    assert (np.diff(found) <= 0).all() and found.min() >= P_FLOOR


def double_integral_far(q: float, k: int, df: int) -> float:
    """Far out only small s count: the density of s is its first terms there, and x = q s is what is integrated over."""
    edges = np.linspace(0.0, 16.0, 65)
    half = np.diff(edges) / 2
    x = (((edges[1:] + edges[:-1]) / 2)[:, None] + half[:, None] * STEP).ravel()
    weights = (half[:, None] * STEP_WEIGHTS).ravel()
    log_density = np.log(2) + df / 2 * np.log(df / 2) - gammaln(df / 2) - df * (x / q) ** 2 / 2
    return float((weights * np.exp(log_density) * x ** (df - 1) / q**df * range_tail(x, k)).sum())


@pytest.mark.parametrize(("k", "df"), [(500, 997_501), (30, 60), (100, 10)])
def test_many_q_are_interpolated_within_1e_10(k: int, df: int) -> None:
    """Among more than 300 distinct q, those that are asked for one by one too."""
    q = np.random.default_rng(k).uniform(0, 14, FEW + 50)
    q[:25] = np.linspace(3, 9, 25)
    some = q[:25]
    exact = np.maximum(stats.studentized_range.sf(some, k, df), P_FLOOR)
    assert tail_probabilities(q, k, df)[:25] == pytest.approx(exact, abs=1e-10)


def test_equal_q_have_equal_p_in_their_places() -> None:
    q = np.array([3.0, 1.0, 3.0, 40.0, 0.0])
    p = tail_probabilities(q, 3, 20)
    assert p[0] == p[2] and p[4] == 1 and p[3] == P_FLOOR
    assert p[1] == pytest.approx(float(stats.studentized_range.sf(1.0, 3, 20)))


def test_the_bound_is_printed_as_one() -> None:
    """No digits where there are none."""
    assert (thesis_p(P_FLOOR), exact_p(P_FLOOR)) == ("< .0001", "< 1e-10")


@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(st.lists(st.integers(1, 7), min_size=3, max_size=3), min_size=4, max_size=6))
def test_q_and_error_are_exact_on_likert_data(table: list[list[int]]) -> None:
    """Mean square of error and q equal the rationals that integers give, in both modes."""
    n, k = len(table), 3
    people = [Fraction(sum(row), k) for row in table]
    means = [Fraction(sum(column), n) for column in zip(*table, strict=True)]
    grand = sum(means) / k
    within = sum((table[i][j] - means[j]) ** 2 for i in range(n) for j in range(k))
    left = sum((table[i][j] - people[i] - means[j] + grand) ** 2 for i in range(n) for j in range(k))
    assume(left > 0)
    cells = [(f"p{i}", f"c{j}", float(table[i][j])) for i in range(n) for j in range(k)]
    frame = pd.DataFrame(cells, columns=["who", "what", "rating"])
    for subject, error in ((None, within / (k * (n - 1))), ("who", left / ((k - 1) * (n - 1)))):
        rows = TukeyHSD("rating", "what", subject)(frame)
        assert rows["mse"].iloc[0] == pytest.approx(float(error), rel=1e-11)
        for row, (a, b) in zip(rows.to_dict("records"), [(0, 1), (0, 2), (1, 2)], strict=True):
            squared = (means[a] - means[b]) ** 2 / (error / n)
            assert row["difference"] == pytest.approx(float(means[a] - means[b]), rel=1e-11, abs=1e-13)
            assert row["q"] ** 2 == pytest.approx(float(squared), rel=1e-10, abs=1e-20)


def test_hundreds_of_means_give_no_warning() -> None:
    """scipy's integral of a probability of 5e-12 (q = 3.4 of 300 means) says that it hardly converges: it need not."""
    with pytest.warns(IntegrationWarning):
        stats.studentized_range.sf(3.4, 300, 12857)
    (p,) = tail_probabilities(np.array([3.4]), 300, 12857)
    assert p == pytest.approx(1, abs=1e-9)
