"""A sweep's levels between two numbers, as they are typed, and as they are shown."""

from importlib.resources import files
from typing import Any

import pytest
from playwright.sync_api import Page

pytestmark = pytest.mark.browser

STATIC = files("fakesss.tuner") / "static"


def served(page: Page) -> None:
    """Open a page beside which the tuner's modules are, and nothing else."""
    page.route("**/*.js", lambda route: route.fulfill(path=str(STATIC / route.request.url.rsplit("/", 1)[1])))
    page.route("**/empty", lambda route: route.fulfill(content_type="text/html", body=""))
    page.goto("http://levels.test/empty")


LEVELS = """async ([from, to, count, isRatios, data]) => {
  const { spaced } = await import("./sweep_levels.js");
  const { Scale } = await import("./numbers.js");
  return spaced(from, to, count, isRatios, new Scale({ low: 0, high: 1, step: 0.01, label: "", ...data }));
}"""


def test_levels_have_no_more_digits_than_they_need(page: Page) -> None:
    served(page)

    def spaced(start: float, end: float, count: int, ratios: bool = False, **data: Any) -> Any:
        return page.evaluate(LEVELS, [start, end, count, ratios, data])

    assert spaced(10, 40, 3) == [10, 25, 40]
    assert spaced(0, 1, 4) == [0, 0.33, 0.67, 1]
    assert spaced(0.00390625, 0.01, 3) == [0.00390625, 0.007, 0.01]
    assert spaced(40, 10, 5) == [40, 32.5, 25, 17.5, 10]
    assert spaced(1, 1000, 4, True) == [1, 10, 100, 1000]
    assert spaced(1e-3, 4e-3, 3, True) == [1e-3, 2e-3, 4e-3]
    assert spaced(1, 3, 4, True) == [1, 1.44, 2.08, 3]
    assert spaced(4, 64, 4, multiple=4, whole="") == [4, 24, 44, 64]
    assert spaced(1, 3, 5, whole="") == [1, 2, 3]


READ = """async ([text, whole]) => {
  const { parsed, shown } = await import("./sweep_levels.js");
  const { Scale } = await import("./numbers.js");
  const { levels, problem } = parsed(text, new Scale({ low: 0, high: 1, step: 1, ...(whole && { whole }) }));
  return problem ?? levels.map((level) => shown(level, levels));
}"""


def test_a_level_is_read_as_it_was_meant_and_shown_as_it_is(page: Page) -> None:
    served(page)

    def read(text: str, whole: str = "") -> Any:
        return page.evaluate(READ, [text, whole])

    assert read("0.5,1, 2;3 4") == ["0.5", "1", "2", "3", "4"]
    assert (
        read("0,3") == read("1 0,3; 2") == 'Is the comma of "0,3" a decimal point? Write a point, or a space after it.'
    )
    assert "decimal point" in read("10,20,30")
    assert read("60.000", "whole") == '"60.000" may be 60 or 60000: write one of these.'
    assert read("123456, 123457", "whole") == ["123456", "123457"]
    assert read("1/3 0.33333 0.5") == ["0.333333", "0.33333", "0.5"]
