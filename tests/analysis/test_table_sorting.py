"""The order that a table's heads sort by: what a reader means by larger, whatever stands around the number."""

import pytest

from analysis.sorting import Line, numbers_in, places, sortable
from analysis.tables import Table


@pytest.mark.parametrize(
    "in_order",
    [
        ["−1.20", "-0.5", "0", ".049", ".5", "3"],
        ["< 1e-10", "1.2e-10", "< .0001", "0.0001", "0.012", "> .99"],
        ["[−.2, .5]", "[.1, .3]", "[.1, .4]"],
        [".290 [.019, .761]", ".715 [.342, .946]"],
        ["2, 86", "2, 129", "3, 12"],
        ["9%", "12%", "100%"],
        ["5 of 9", "12 of 30"],
        ["999", "1,000", "1,234,567"],
    ],
)
def test_numbers_in_their_dress(in_order: list[str]) -> None:
    assert places(in_order[::-1], words=False) == list(range(len(in_order)))[::-1]


def test_equal_contents_share_a_place_and_what_is_no_number_has_none() -> None:
    assert places(["0.5", "–", "0.50", "", "no value", "−2"], words=False) == [1, None, 1, None, None, 0]


def test_words_as_people_sort_them() -> None:
    assert places(["image 10", "Image 2", "apple", ""], words=True) == [2, 1, 0, None]
    assert places(["undecided", "equivalent"], words=False) == [1, 0]


def test_numbers_read() -> None:
    assert numbers_in("F(1.67, 1,071.94) < .05") == ((1.67, 0), (1071.94, 0), (0.05, -1))
    assert numbers_in("−3.2e−5") == ((-3.2e-5, 0),)


def test_an_empty_first_cell_stands_for_the_one_above() -> None:
    table = Table("t", "pairs", ("row", "pair", "p"), (("b", "x", ".2"), ("", "y", ".1"), ("a", "x", ".3")), 2)
    lines = sortable(table)
    assert [(line.begins, line.cells[0].text, line.cells[0].meant, line.cells[0].place) for line in lines] == [
        (True, "b", "b", 1),
        (False, "", "b", 1),
        (True, "a", "a", 0),
    ]
    assert [line.cells[2].place for line in lines] == [1, 0, 2]
    assert sortable(Table("t", "nothing", ("a",), ())) == []
    assert not any(
        isinstance(line, Line) and line.begins for line in sortable(Table("t", "", ("a",), (("x",), ("y",))))
    )
