"""Layers in half floats: how wrong a thickness may be, what memory they take, and that the peel still parts them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from picture_scenes import sheet_file

from fakesss.frame_graph import Pass, TextureSpec
from fakesss.inspect import compiled
from fakesss.memory import peak_bytes
from fakesss.pipeline import build
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene

SEEN = {"camera.azimuth": 25.0, "camera.elevation": 20.0}
HALF = {"layers.depth": "float16"}
SPACING = 2**-9  # sphere radii, of float16 from 2 to 4: OpenGL may round to either neighbour
WAYS: list[tuple[dict[str, Any], int]] = [  # and how often the second layer is rounded
    ({}, 1),
    ({"layers.method": "peel"}, 1),
    ({"material.thickness": "total-path"}, 1),
    ({"layers.resolution": 2}, 2),
]


def layers(renderer: Renderer, scene: Scene, *names: str) -> list[Any]:
    data = [renderer.data(s, names) for s in (scene, scene.replace(HALF))]
    return [[one[name] for name in names] for one in data]


@pytest.mark.gl
@pytest.mark.parametrize(("changes", "rounded"), WAYS, ids=str)
def test_a_thickness_is_wrong_by_at_most_a_spacing(renderer: Renderer, changes: dict[str, Any], rounded: int) -> None:
    """Two depths, each rounded by less than 2^-9 radii to the same side or not: 1e-3 diameters."""
    scene = Scene(object="knot:8000", size=(128, 128)).replace({**SEEN, **changes})
    (full_front, full), (front, half) = layers(renderer, scene, "front", "thickness")
    assert 0 < np.abs(front - full_front).max() <= SPACING
    error = np.abs(half - full)[full_front > 0]
    assert 0 < error.max() <= rounded * SPACING / 2


@pytest.mark.gl
@pytest.mark.parametrize("policy", ["thin", "thick"])
def test_an_open_sheet_is_not_peeled_from_itself(renderer: Renderer, tmp_path: Path, policy: str) -> None:
    """However it is turned: its own rounded depth does not come to lie behind it."""
    scene = Scene(object=sheet_file(tmp_path), size=(48, 48), open_surface=policy).replace(HALF)  # type: ignore[arg-type]
    for azimuth in (0.0, 40.0, 75.0):
        data = renderer.data(scene.replace({"camera.azimuth": azimuth}), ("thickness", "front"))
        covered = data["front"] > 0
        np.testing.assert_array_equal(data["thickness"][covered], 0.0 if policy == "thin" else 1.0)


@pytest.mark.gl
def test_bridged_layers_alternate_as_before(renderer: Renderer) -> None:
    scene = Scene(object="figure:8000", size=(128, 128)).replace({**SEEN, "material.thickness": "bridged"})
    (_, full), (_, half) = layers(renderer, scene, "front", "thickness")
    error = np.abs(half - full)[full > 0]
    assert np.percentile(error, 99) < 3e-3 and (error > 0.01).mean() < 5e-3


PICTURES: list[dict[str, Any]] = [
    {},
    {"occlusion.method": "screen-space", "light.ambient": (0.6, 0.6, 0.6)},
    {"light.shadows": True, "light.azimuth": -70.0, "material.diffuse_contribution": 0.3},
    {"light.kind": "point", "light.distance": 2.0},
]


@pytest.mark.gl
@pytest.mark.parametrize("changes", PICTURES, ids=str)
def test_the_picture_changes_little(renderer: Renderer, changes: dict[str, Any]) -> None:
    """At most 25 times a thickness's error where the backlight is steepest, and a shadow's edge moves a little."""
    scene = Scene(object="knot:8000", size=(96, 96)).replace({**SEEN, **changes})
    full, half = (renderer.render(one).image for one in (scene, scene.replace(HALF)))
    error = np.abs(half - full)[full[..., 3] > 0].max(axis=1)
    assert 0 < error.mean() < 1e-3 and np.percentile(error, 99) < 5e-3 and error.max() < 0.03


def test_layers_take_half_the_memory_and_nothing_else_does() -> None:
    changes = {**HALF, "layers.resolution": 2, "blur.kernel": "separable", "material.backlight": 1.0}
    for more in ({}, {"material.thickness": "bridged"}, {"material.thickness": "total-path"}):
        graph = build(Scene(size=(40, 30)).replace({**changes, **more}), 1, True)
        written = {name: spec for node in graph.nodes if isinstance(node, Pass) for name, spec in node.writes.items()}
        halves = {name for name, spec in written.items() if spec.numbers == "float16"}
        others = {"surface", "coverage", "sparse_coverage", "path", "thickness", "blurred_thickness"}
        others |= {"sampled_occlusion", "screen_occlusion", "shadow_maps", "shaded", "resolved"}
        assert halves == set(written) - others
    assert TextureSpec((40, 30), 1, "float16").bytes == 40 * 30 * 2


def test_the_picture_takes_less_memory() -> None:
    scene = Scene(object="torus:4000", size=(60, 44), supersampling=1)
    plane = 60 * 44 * 4
    full, half = (peak_bytes(compiled(one)) for one in (scene, scene.replace(HALF)))
    assert full - half == 2 * plane // 2  # front and nearest_back
    sparse = peak_bytes(compiled(scene.replace({"layers.resolution": 2})))
    assert (
        full - sparse == 2 * plane - 3 * plane // 4
    )  # layer and depth buffer; of the sparse one also what is softened


def test_only_two_formats_can_be_had() -> None:
    with pytest.raises(BadInput, match=r"study.toml: .*layers.depth"):
        Scene().replace({"layers.depth": "float64"}, "study.toml")
