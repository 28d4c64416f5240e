"""Where a statistic has no value, its user gets a sentence."""

import pandas as pd
import pytest

from analysis import Friedman, OneWayAnova, RepeatedMeasuresAnova, SignedRanks, TukeyHSD
from fakesss.problem import BadInput

ONE_WAY = OneWayAnova(value="rating", group="condition")
REPEATED = RepeatedMeasuresAnova(value="rating", within="condition", subject="participant")
FRIEDMAN = Friedman(value="rating", within="condition", subject="participant")
SIGNED_RANKS = SignedRanks(value="rating", within="condition", subject="participant")
TUKEY = TukeyHSD(value="rating", group="condition")


def long(*rows: str) -> pd.DataFrame:
    """ "177" is a participant's ratings of conditions a, b, c; a space is a missing cell."""
    return pd.DataFrame(
        [
            {"participant": f"p{who}", "condition": name, "rating": float(rating)}
            for who, row in enumerate(rows, 1)
            for name, rating in zip("abcdefg", row, strict=False)
            if rating != " "
        ]
    )


@pytest.mark.parametrize(
    ("statistic", "frame", "sentence"),
    [
        (ONE_WAY, long("444", "444"), "rating by condition: all ratings are equal, so F has no value"),
        (REPEATED, long("444", "444"), "rating by condition: all ratings are equal, so F has no value"),
        (TUKEY, long("444", "444"), "all ratings are equal"),
        (ONE_WAY, long("147", "147"), "within each level all ratings are equal, so F has no value"),
        (REPEATED, long("147", "258", "147"), "every participant shows exactly the same differences"),
        (REPEATED, long("147"), "1 of 1 participants rated every level; at least two must have"),
        (REPEATED, long("14 ", "2 5", "367"), "1 of 3 participants rated every level; at least two must have"),
        (ONE_WAY, long("4", "5"), "1 level with ratings; a comparison needs at least two"),
        (ONE_WAY, long("14", "5"), 'level "b" has one rating; each level needs at least two'),
        (FRIEDMAN, long("44", "45"), "Friedman's test needs three levels and there are 2"),
        (FRIEDMAN, long("444", "555"), "everyone rated all levels the same, so there are no ranks"),
        (SIGNED_RANKS, long("123", "321"), "Wilcoxon's test needs two levels and there are 3"),
        (SIGNED_RANKS, long("44", "55"), "everyone rated both levels the same, so there are no ranks"),
        (REPEATED, pd.concat([long("147", "235")] * 2), 'participant "p1" has two values at condition "a"'),
        (
            ONE_WAY,
            long("147", "235").rename(columns={"rating": "ratings"}),
            'no column "rating"; did you mean "ratings"?',
        ),
    ],
)
def test_sentence(statistic: object, frame: pd.DataFrame, sentence: str) -> None:
    """No NaN, no invented F, no traceback: what is wrong, in words."""
    with pytest.raises(BadInput) as error:
        statistic(frame)  # type: ignore[operator]
    assert sentence in str(error.value)


def test_unused_level_is_no_level() -> None:
    """A declared level that nobody rated changes nothing."""
    frame = long("146", "235", "527")
    with_unused = frame.assign(condition=pd.Categorical(frame["condition"], ["a", "b", "c", "never shown"]))
    for statistic in (ONE_WAY, REPEATED):
        assert statistic(with_unused).iloc[0]["F"] == statistic(frame).iloc[0]["F"]
