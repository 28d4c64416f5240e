"""The measured media: the reflectances that the paper prints come out again, and slips of ten do not pass."""

import numpy as np
import pytest

from fakesss.media import (
    MEDIA,
    A_boundary,
    D_diffusion,
    F_dr,
    Medium,
    alpha_prime,
    medium_named,
    sigma_t_prime,
    sigma_tr,
    total_diffuse_reflectance,
)
from fakesss.problem import BadInput

# Jensen et al. 2001, figure 5: diffuse reflectance as the paper prints it.
PRINTED = {
    "apple": (0.85, 0.84, 0.53),
    "chicken1": (0.31, 0.15, 0.10),
    "chicken2": (0.32, 0.16, 0.10),
    "cream": (0.98, 0.90, 0.73),
    "ketchup": (0.16, 0.01, 0.00),
    "marble": (0.83, 0.79, 0.75),
    "potato": (0.77, 0.62, 0.21),
    "skimmilk": (0.81, 0.81, 0.69),
    "skin1": (0.44, 0.22, 0.13),
    "skin2": (0.63, 0.44, 0.34),
    "spectralon": (1.00, 1.00, 1.00),
    "wholemilk": (0.91, 0.88, 0.76),
}
WITHIN = 0.03


def reflectance(medium: Medium) -> np.ndarray:
    return total_diffuse_reflectance(medium.sigma_s_prime, medium.sigma_a, medium.eta)


def test_there_are_the_twelve_of_the_paper() -> None:
    assert set(MEDIA) == set(PRINTED)
    assert all(name == medium.name for name, medium in MEDIA.items())


@pytest.mark.parametrize("name", PRINTED)
def test_the_reflectance_is_the_printed_one(name: str) -> None:
    np.testing.assert_allclose(reflectance(MEDIA[name]), PRINTED[name], atol=WITHIN)


SLIPS = [(name, channel) for name in PRINTED for channel in range(3) if PRINTED[name][channel] not in (0.0, 1.0)]


@pytest.mark.parametrize(("name", "channel"), SLIPS)
@pytest.mark.parametrize("field", ["sigma_s_prime", "sigma_a"])
@pytest.mark.parametrize("slip", [0.1, 10.0])
def test_a_number_wrong_by_ten_would_be_found(name: str, channel: int, field: str, slip: float) -> None:
    numbers = {"sigma_s_prime": list(MEDIA[name].sigma_s_prime), "sigma_a": list(MEDIA[name].sigma_a)}
    numbers[field][channel] *= slip
    wrong = total_diffuse_reflectance(numbers["sigma_s_prime"], numbers["sigma_a"], MEDIA[name].eta)[channel]
    # a green or blue ketchup reflects next to nothing either way, and the cleanest cream next to everything
    blind = max(wrong, PRINTED[name][channel]) < 0.05 or min(wrong, PRINTED[name][channel]) > 0.95
    assert blind or abs(wrong - PRINTED[name][channel]) > WITHIN


def test_formulas_at_a_known_place() -> None:
    s, a = 2.0, 0.5
    assert sigma_t_prime(s, a) == pytest.approx(2.5)
    assert alpha_prime(s, a) == pytest.approx(0.8)
    assert D_diffusion(s, a) == pytest.approx(1 / 7.5)
    assert sigma_tr(s, a) == pytest.approx(np.sqrt(a / D_diffusion(s, a)))


@pytest.mark.parametrize(("eta", "a"), [(1.3, 2.602), (1.5, 3.959)])
def test_the_boundary_term_is_the_known_one(eta: float, a: float) -> None:
    assert A_boundary(eta) == pytest.approx(a, abs=1e-3)


def test_a_boundary_of_equal_indices_reflects_nothing() -> None:
    assert F_dr(1.0) == pytest.approx(0, abs=0.002)
    assert A_boundary(1.0) == pytest.approx(1, abs=0.004)


def test_nothing_absorbed_is_all_reflected() -> None:
    assert total_diffuse_reflectance(3.0, 0.0, 1.3) == pytest.approx(1)


@pytest.mark.parametrize("name", ["marble", "Marble", "medium.marble", "MEDIUM.MARBLE"])
def test_a_medium_by_its_names(name: str) -> None:
    assert medium_named(name, "--to") is MEDIA["marble"]


def test_a_misspelt_medium_names_the_nearest() -> None:
    with pytest.raises(BadInput, match=r'--to: "medium\.marbel" is no measured medium; did you mean "marble"'):
        medium_named("medium.marbel", "--to")
