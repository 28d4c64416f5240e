"""docs/equivalence.md: every number it prints is computed again."""

import doctest
import re
from math import sqrt
from pathlib import Path

import pytest
from scipy import stats

from analysis.statistics.equivalence_power import equivalence_power, people_for_equivalence

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "equivalence.md").read_text(encoding="utf-8")
PROSE = " ".join(re.sub(r"```.*?```", "", PAGE, flags=re.S).split())


def test_the_code_of_the_page_prints_what_it_says(monkeypatch: pytest.MonkeyPatch) -> None:
    """All blocks in one namespace, as a reader would type them."""
    monkeypatch.chdir(ROOT)
    names: dict[str, object] = {}
    runner = doctest.DocTestRunner()
    blocks = re.findall(r"```python\n(.*?)```", PAGE, re.S)
    for block in blocks:
        example = doctest.DocTestParser().get_doctest(block, names, "equivalence.md", None, 0)
        runner.run(example, clear_globs=False)
        names = example.globs
    assert len(blocks) == 5 and runner.summarize(verbose=False).failed == 0


def test_the_numbers_of_the_prose() -> None:
    """The claim of the specification: half-width 0.53, about 151 people for 80% power, from the printed HSD."""
    sd = sqrt(2 * 2.19)
    half = stats.t.ppf(0.95, 43) * sd / sqrt(44)
    few, many = (people_for_equivalence(sqrt(2 * 44) * root, 0.5) for root in (0.221, 0.225))
    said = (
        f"reaches {half:.2f} to both sides",
        f"about {44 * 0.223**2:.2f}",
        "About 151 people for 80% power",
        f"{few} to {many} over the range",
        f"the chance was {equivalence_power(44, sd, 0.5):.1%}",
    )
    assert [words for words in said if words not in PROSE] == []
    assert round(equivalence_power(151, sd, 0.5), 2) == 0.80
    # HSD of .82 over q(4, 129) and q(4, 50): sqrt(MSE / n)
    roots = [value / stats.studentized_range.ppf(0.95, 4, df) for value, df in ((0.815, 129), (0.825, 60))]
    assert roots[0] == pytest.approx(0.221, abs=1e-3) and roots[1] == pytest.approx(0.221, abs=4e-3)
