"""What keeps figures small and quick leaves them true: classes of means, thumbnails decoded once."""

import os
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from PIL import Image

from analysis.figures.means import DISCS, discs_named, draw_answers
from analysis.figures.style import thumbnail


def discs(ratings: list[float]) -> tuple[SimpleNamespace, np.ndarray, np.ndarray]:
    """A row of one level with these answers; heights and areas of its discs."""
    each = SimpleNamespace(answers=pd.DataFrame({"condition": "M1", "rating": ratings}))
    axes = Figure().subplots()
    draw_answers(axes, each, ["M1"])
    (drawn,) = axes.collections
    return each, np.asarray(drawn.get_offsets())[:, 1], drawn.get_sizes()


def test_single_answers_stand_where_they_were_given() -> None:
    each, heights, areas = discs([1, 4, 4, 7])
    assert sorted(heights) == [1, 4, 7] and areas.max() == pytest.approx(2 * areas.min())
    assert "all answers" in discs_named([each])


def test_means_of_many_pictures_stand_in_classes() -> None:
    """2,000 different means make at most 61 discs, none farther from its own than half a class."""
    ratings = np.random.default_rng(1).uniform(1, 7, 2000)
    each, heights, areas = discs(list(ratings))
    assert len(heights) <= DISCS + 1 and areas.sum() == pytest.approx(800)
    nearest = np.abs(ratings[:, None] - heights).min(axis=1)
    assert nearest.max() <= np.ptp(ratings) / DISCS / 2 + 1e-12
    assert "in classes" in discs_named([each])


def test_a_picture_that_changed_is_decoded_again(tmp_path: Path) -> None:
    file = tmp_path / "a.png"
    Image.new("RGB", (8, 8), "red").save(file)
    first = thumbnail(file)
    assert thumbnail(file) is first and first.getpixel((0, 0)) == (255, 0, 0)
    Image.new("RGB", (8, 8), "blue").save(file)
    os.utime(file, ns=(1, 1))
    assert thumbnail(file).getpixel((0, 0)) == (0, 0, 255)
