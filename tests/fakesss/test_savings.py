"""What leaving out an effect saves, and that the picture is the same to the byte."""

import os
from pathlib import Path
from typing import Any

import pytest

from fakesss.gpu import Gpu
from fakesss.inspect import savings
from fakesss.savings import in_vain, without_cache
from fakesss.scene import Scene

BACKLIGHT, OCCLUSION, SPECULAR = frozenset({"backlight", "blur"}), frozenset({"occlusion"}), frozenset({"specular"})


IN_VAIN: list[tuple[dict[str, Any], set[frozenset[str]]]] = [
    ({}, set()),
    ({"material.backlight": 0.0}, {BACKLIGHT}),
    ({"material.backlight": 0.0, "blur.enabled": False}, {frozenset({"backlight"})}),
    ({"light.ambient": (0, 0, 0)}, {OCCLUSION}),
    ({"light.ambient": (0, 0, 0), "occlusion.enabled": False}, set()),
    ({"blur.enabled": False}, set()),
    ({"material.specular": 0.0, "material.ambient": 0.0}, {SPECULAR, OCCLUSION}),
]


@pytest.mark.parametrize(("changes", "effects"), IN_VAIN, ids=[str(changes) for changes, _ in IN_VAIN])
def test_what_weighs_nothing_and_is_not_switched_off(changes: dict[str, Any], effects: set[frozenset[str]]) -> None:
    found = in_vain(Scene().replace(changes))
    assert found.keys() == effects
    assert all(reason.endswith(" is 0") for reason in found.values())


@pytest.mark.gl
def test_every_saving_leaves_the_picture_as_it_is(gpu: Gpu) -> None:
    changes = {"material.backlight": 0.0, "material.ambient": 0.0, "material.specular": 0.0}
    rows = {row["effects"][0]: row for row in savings(Scene(object="torus:4000", size=(64, 48)).replace(changes))}
    assert rows.keys() == {"backlight", "occlusion", "specular"}
    for row in rows.values():
        assert row["same_bytes"] and row["forced_bytes"] >= row["bytes"] > 0
        assert row["forced_ms"] > row["saved_ms"] and row["noise_ms"] >= 0
    assert rows["backlight"]["forced_bytes"] > rows["backlight"]["bytes"]
    assert rows["occlusion"]["bake_seconds"] > 0 and rows["backlight"]["bake_seconds"] == 0


@pytest.mark.gl
def test_a_picture_that_calls_for_all_saves_nothing(gpu: Gpu) -> None:
    assert savings(Scene(object="torus:4000", size=(16, 16))) == []


def test_the_cache_is_back_afterwards(monkeypatch: pytest.MonkeyPatch) -> None:
    for before in ("/somewhere", None):
        monkeypatch.setenv("FAKESSS_CACHE", "x")
        if before is None:
            monkeypatch.delenv("FAKESSS_CACHE")
        else:
            monkeypatch.setenv("FAKESSS_CACHE", before)
        with pytest.raises(RuntimeError), without_cache():
            assert list(Path(os.environ["FAKESSS_CACHE"]).iterdir()) == []
            raise RuntimeError
        assert os.environ.get("FAKESSS_CACHE") == before
