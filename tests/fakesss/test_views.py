"""The views by name: complete, documented, and the data that the renderer gives."""

from pathlib import Path

import numpy as np
import pytest

from fakesss.contact_sheet import Panel, Plot
from fakesss.profile_plot import Profile, profile_plot
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.views import KINDS, ROWS, layers_of, runs, view, views

DOCS = Path(__file__).parents[2] / "docs" / "views.md"
NAMES = [name for row in ROWS for name in row]


@pytest.mark.gl
def test_every_view_is_made_and_holds_data(renderer: Renderer) -> None:
    scene = Scene(object="torus:4000", size=(60, 40)).replace({"blur.step": 0.02})
    made = views(scene)
    assert list(made) == NAMES
    data = renderer.data(scene, ("front", "second", "thickness", "blurred_thickness"))
    panels = {name: view for name, view in made.items() if isinstance(view, Panel)}
    for name in ("thickness", "blurred_thickness"):
        assert (panels[name].values == data[name]).all()
    for name in ("front", "second"):
        assert (panels[name].values == data[name] - 1).all()
    assert (panels["softening"].values == data["blurred_thickness"] - data["thickness"]).all()
    assert panels["softening"].values.any()
    assert all(panel.values.shape[:2] == (40, 60) for panel in panels.values())
    plots = [view.draw((300, 200)) for view in made.values() if isinstance(view, Plot)]
    assert [drawing.shape for drawing in plots] == [(200, 300, 3)] * 2


SHELL = Scene(object="shell:8000", size=(60, 48)).replace({"camera.azimuth": 25.0, "occlusion.rays": 32})


@pytest.fixture(scope="module")
def together() -> dict[str, Panel | Plot]:
    return views(SHELL)


@pytest.mark.gl
@pytest.mark.parametrize("name", NAMES)
def test_a_view_alone_is_the_one_among_all(together: dict[str, Panel | Plot], name: str) -> None:
    alone, among = view(SHELL, name), together[name]
    assert (alone.title, alone.note) == (among.title, among.note)
    if isinstance(alone, Panel):
        assert isinstance(among, Panel)
        np.testing.assert_array_equal(alone.values, among.values)
        np.testing.assert_array_equal(alone.pixels(), among.pixels())
        assert alone.limits == among.limits
    else:
        assert isinstance(among, Plot)
        np.testing.assert_array_equal(alone.draw((120, 90)), among.draw((120, 90)))


def test_a_view_alone_asks_for_its_own_layers_only() -> None:
    """So that no view bakes what it does not show."""
    assert set(KINDS) == set(NAMES)
    assert layers_of(SHELL, ["second"]) == (SHELL, ("second",))
    assert layers_of(SHELL, ["specular"]) == (SHELL, ())
    assert layers_of(SHELL, ["normals", "hard_edges"]) == (SHELL, ("front", "surface", "thickness"))
    scene, layers = layers_of(SHELL.replace({"occlusion.enabled": False}), ["occlusion"])
    assert layers == ("front", "surface") and scene.occlusion.enabled
    assert layers_of(SHELL.replace({"occlusion.method": "screen-space"}), ["occlusion"])[1][1] == "screen_occlusion"


@pytest.mark.parametrize("name", NAMES)
def test_every_view_is_documented(name: str) -> None:
    assert f"`{name}`" in DOCS.read_text(encoding="utf-8")


def test_runs_are_marked_once_in_their_middle() -> None:
    marked = np.array([1, 1, 0, 0, 1, 0, 1, 1, 1], bool)
    assert runs(np.arange(9.0), marked) == [0.5, 4, 7]
    assert runs(np.arange(3.0), np.zeros(3, bool)) == []


def test_the_profile_follows_its_curves() -> None:
    """A hill in the middle third: the drawing differs from an empty one there, and nowhere above the curve."""
    across = np.linspace(-0.5, 0.5, 101)
    nothing = np.full(101, np.nan)
    empty = profile_plot(Profile(across, nothing, nothing, []), (400, 300))
    hill = np.where(np.abs(across) < 0.17, 0.3, 0.01)
    drawn = profile_plot(Profile(across, hill, hill, [0.0]), (400, 300))
    assert empty.shape == drawn.shape == (300, 400, 3)
    filled = drawn.astype(int).sum(axis=2)
    assert filled[150, 190] > filled[150, 90] and filled[150, 190] > filled[30, 190]


@pytest.mark.parametrize("edge", [-0.35, 0.0, 0.2])
def test_the_red_line_stands_at_its_edge(edge: float) -> None:
    """The plot is 334 pixels wide from 52 on, and shows what is covered with 3% more on either side."""
    across = np.linspace(-0.5, 0.5, 101)
    flat = np.full(101, 0.1)
    drawn = profile_plot(Profile(across, flat, flat, [edge]), (400, 300)).astype(int)
    red = drawn[..., 0] - drawn[..., 1:].max(axis=2)
    assert abs(red[100:200].sum(axis=0).argmax() - (52 + 334 * (edge + 0.53) / 1.06)) <= 1
