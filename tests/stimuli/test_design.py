"""Designs against the published table and against counting."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fakesss.problem import BadInput
from stimuli.design import stimuli_of
from stimuli.study import Study
from stimuli.template import write_template

# Gascons 2011, table 4.3: thickness exponent, backlight contribution, diffuse weight of images 1 to 9.
TABLE_4_3 = [
    (25, 1.2, 0.2),
    (18, 1.2, 0.2),
    (30, 1.2, 0.2),
    (25, 1.2, 0.2),
    (25, 0.8, 0.2),
    (25, 1.6, 0.2),
    (25, 1.2, 0.2),
    (25, 1.2, 0.0),
    (25, 1.2, 0.5),
]


def study(**changes: Any) -> Study:
    factors = [
        {"name": "r", "path": "material.thickness_exponent", "levels": [25, 18, 30]},
        {"name": "wb", "path": "material.backlight", "levels": [1.2, 0.8]},
    ]
    return Study.model_validate({"title": "x", "factor": factors, **changes})


def test_the_thesis_template_is_table_4_3(tmp_path: Any) -> None:
    write_template(tmp_path, "thesis")
    every = stimuli_of(Study.load(tmp_path))
    stimuli, offline = every[:9], every[9:]
    assert [tuple(dict(s.factors).values()) for s in stimuli] == TABLE_4_3
    assert [s.id for s in stimuli] == [f"img0{n}" for n in range(1, 10)]
    assert [s.same_picture_as for s in stimuli] == [None, None, None, "img01", None, None, "img01", None, None]
    assert [s.rows for s in stimuli[::3]] == [("thickness exponent",), ("backlight",), ("diffuse weight",)]
    assert [s.id for s in offline] == [f"img{n}" for n in range(10, 16)]  # as many as in section 4.2
    assert len({(s.path_tracing.medium, s.scene.light.azimuth) for s in offline if s.path_tracing and s.scene}) == 6


def test_levels_reach_the_scene() -> None:
    for stimulus in stimuli_of(study()):
        assert stimulus.scene is not None
        levels = dict(stimulus.factors)
        assert stimulus.scene.material.thickness_exponent == levels["r"]
        assert stimulus.scene.material.backlight == levels["wb"]


def test_show_once_lists_a_shared_picture_once_for_every_row() -> None:
    stimuli = stimuli_of(study(design={"identical": "show-once"}))
    assert len(stimuli) == 4
    assert stimuli[0].rows == ("r", "wb")
    assert all(s.same_picture_as is None for s in stimuli)


@given(st.lists(st.integers(1, 4), min_size=1, max_size=3))
def test_a_full_factorial_has_every_combination_once(counts: list[int]) -> None:
    paths = ["material.thickness_exponent", "material.backlight", "material.diffuse_weight"]
    factors = [
        {"name": path, "path": path, "levels": [1.5 + n for n in range(count)]}
        for path, count in zip(paths, counts, strict=False)
    ]
    stimuli = stimuli_of(Study.model_validate({"title": "x", "factor": factors, "design": {"kind": "full-factorial"}}))
    assert len({s.factors for s in stimuli}) == len(stimuli) == math.prod(counts)
    assert all(len(s.rows) == len(counts) for s in stimuli)


def test_repeats_are_drawn_by_the_seed_and_name_their_original() -> None:
    chosen = [s for s in stimuli_of(study(design={"repeats": 2})) if s.role == "repeat"]
    assert len(chosen) == 2
    assert all(s.id == f"{s.same_picture_as}r" and s.rows == () for s in chosen)
    assert chosen == [s for s in stimuli_of(study(design={"repeats": 2})) if s.role == "repeat"]


def test_more_repeats_than_pictures_are_refused() -> None:
    with pytest.raises(BadInput, match=r"design\.repeats: 5: must be <= 4"):
        stimuli_of(study(design={"repeats": 5}))


def test_comparison_pictures_come_after_ours_and_belong_to_no_row() -> None:
    stimuli = stimuli_of(study(compare=[{"image": "offline.png", "label": "marble"}]))
    assert (stimuli[-1].id, stimuli[-1].role, stimuli[-1].label, stimuli[-1].rows) == ("img06", "compare", "marble", ())
