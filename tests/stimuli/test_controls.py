"""Control pictures: the renderer's, rated beside the others, in no factor's row."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_build import STUDY
from test_study import FACTOR, load

from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from stimuli.build import build, verify
from stimuli.control import Control
from stimuli.design import stimuli_of
from stimuli.sources import check_sources

OPAQUE = '[[control]]\nlabel = "opaque"\nset = { material.backlight = 0, material.diffuse_contribution = 1.0 }\n'


def test_a_control_is_the_base_scene_with_fields_set_and_in_no_row(tmp_path: Path) -> None:
    study = load(tmp_path, f'title = "x"\n{FACTOR}{OPAQUE}[[compare]]\nimage = "a.png"\n')
    stimuli = stimuli_of(study)
    assert [(s.id, s.role) for s in stimuli] == [
        ("img01", "factor"), ("img02", "factor"), ("img03", "compare"), ("img04", "control"),
    ]  # fmt: skip
    control = stimuli[3]
    assert control.scene == study.scene.replace({"material.backlight": 0, "material.diffuse_contribution": 1.0})
    assert (control.label, control.rows, control.factors, control.same_picture_as) == ("opaque", (), (), None)


@pytest.mark.parametrize(
    "table",
    ['set = { "material.backlight" = 0.5 }', "set.material.backlight = 0.5", "[control.set.material]\nbacklight = 0.5"],
)
def test_a_field_may_be_written_as_a_path_or_as_tables(tmp_path: Path, table: str) -> None:
    (only,) = stimuli_of(load(tmp_path, f'title = "x"\n[[control]]\nlabel = "dim"\n{table}\n'))
    assert only.scene is not None and only.scene.material.backlight == 0.5


def test_a_control_that_changes_nothing_names_the_picture_it_is(tmp_path: Path) -> None:
    study = load(tmp_path, f'title = "x"\n{FACTOR}[[control]]\nlabel = "base"\nset.exposure = 0.9\n')
    assert [s.same_picture_as for s in stimuli_of(study)] == [None, None, "img01"]


def test_controls_are_drawn_by_lot_for_repeats_like_others(tmp_path: Path) -> None:
    study = load(tmp_path, f'title = "x"\n[design]\nrepeats = 3\n{FACTOR}{OPAQUE}')
    assert [s.id for s in stimuli_of(study)][3:] == ["img01r", "img02r", "img03r"]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            'label = "a"\nset = { material.baklight = 0 }',
            'study.toml: control "a": path "material.baklight" is no scene field; did you mean "material.backlight"?',
        ),
        (
            'label = "a"\nset = { material.specular = -1 }',
            'study.toml: control "a": material.specular: -1: must be >= 0',
        ),
        (
            'label = "a"\nset = { exposure = inf }',
            'control "a": exposure = inf: must be a finite number, true or false',
        ),
        ('label = "a"\nset = { lights.0.azimuth = 1 }', 'control "a": path "lights.0.azimuth": counts from lights.0'),
        ('label = "a"\nset = { alpha = true }', 'control "a": a browser would show its page through the picture'),
        ('label = "a"\nset = {}', 'study.toml: control "a": sets nothing; name a field, for example set = {'),
        ('label = "a"\nset.material = {}', 'study.toml: control "a": sets nothing'),
        (
            'label = "a"\nkind = "lambert"',
            "study.toml: control[1].kind: 'lambert': must be 'lambertian' or 'ganzfeld'",
        ),
        ('label = "a"\nset = 1', "study.toml: control[1].set: 1: must be"),
        ("set.exposure = 1", "study.toml: control[1].label: is missing; add it"),
        ('label = ""\nset.exposure = 1', "study.toml: control[1].label: '': must not be empty; write a word"),
        (
            'label = "=x"\nset.exposure = 1',
            'control label "=x" would be a formula in a spreadsheet; begin it with a letter',
        ),
        (
            'label = "a"\nset.size = [20, 20]',
            'study.toml: control "a": size = [20, 20]: all pictures of a study have one size; set it in [scene]',
        ),
        (
            'label = "a"\nset = { material.backlight = 0, "material.backlight" = 1 }',
            'study.toml: control "a": material.backlight stands twice; remove one',
        ),
        ('label = "a"\nlevels = [1]\nset.exposure = 1', "study.toml: control[1].levels: unknown key"),
        (
            'label = "a"\nset.exposure = 1\n[[control]]\nlabel = "a"\nset.exposure = 2',
            'control label "a" is used twice; give each its own',
        ),
    ],
)
def test_bad_controls_get_one_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    with pytest.raises(BadInput) as caught:
        load(tmp_path, f'title = "x"\n{FACTOR}[[control]]\n{text}\n')
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_label_of_a_picture_made_elsewhere_is_no_formula_either(tmp_path: Path) -> None:
    with pytest.raises(
        BadInput, match='compare label "@x" would be a formula in a spreadsheet; begin it with a letter'
    ):
        load(tmp_path, 'title = "x"\n[[compare]]\nimage = "a.png"\nlabel = "@x"\n')


def test_the_size_of_pictures_is_no_factor(tmp_path: Path) -> None:
    with pytest.raises(BadInput) as caught:
        load(tmp_path, 'title = "x"\n[[factor]]\nname = "big"\npath = "size"\nlevels = [[64, 64], [128, 128]]\n')
    assert str(caught.value) == (
        'study.toml: factor "big": path "size": all pictures of a study have one size; set it in [scene]'
    )


def test_an_object_that_is_not_there_is_looked_for_in_the_control(tmp_path: Path) -> None:
    study = load(tmp_path, f'title = "x"\n{FACTOR}[[control]]\nlabel = "mine"\nset.object = "mine.ply"\n')
    with pytest.raises(BadInput, match=r'study\.toml: control "mine": object "mine\.ply": cannot be read'):
        check_sources(study, stimuli_of(study), tmp_path)


@pytest.mark.gl
def test_a_control_is_built_like_any_picture(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY + OPAQUE, encoding="utf-8")
    manifest = build(tmp_path, quiet=True)
    control = manifest["stimuli"][-1]
    assert (control["id"], control["role"], control["label"]) == ("img05", "control", "opaque")
    assert control["scene"]["material"]["backlight"] == 0 and "blur" not in control["passes"]
    # the object is the same, though nothing of this picture needs to know how thick it is
    assert control["cues"]["mean_thickness"] == manifest["stimuli"][0]["cues"]["mean_thickness"]
    assert "control" not in manifest["study"]
    assert verify(tmp_path, quiet=True) == []


def preset(kind: str, **changes: Any) -> Scene:
    """The scene of a control of that kind, of a study with two coloured lights and little ambient light."""
    blue = {"azimuth": 60.0, "diffuse": (0.1, 0.2, 0.9), "ambient": (0.0, 0.0, 0.3)}
    base = Scene(object="knot:4000", size=(64, 64), supersampling=1).replace({"lights": [blue]})
    return Control.model_validate({"label": "opaque", "kind": kind, "set": changes}).scene(base)


@pytest.mark.gl
@pytest.mark.parametrize("kind", ["lambertian", "ganzfeld"])
def test_an_opaque_control_is_drawn_without_any_thickness(kind: str) -> None:
    passes = {timing["name"] for timing in Renderer().render(preset(kind)).passes}
    assert "front" in passes and "shade" in passes
    assert passes.isdisjoint({"back_faces", "peel", "blur", "total_path", "bridge", "local_exit"})


@pytest.mark.gl
def test_a_ganzfeld_picture_is_albedo_times_ambient_times_occlusion() -> None:
    scene = preset("ganzfeld")
    found = Renderer().data(scene, ("image", "surface"))
    inside = found["image"][..., 3] > 0
    occlusion = found["surface"][..., 3][inside]
    assert occlusion.min() < 0.5 < 0.99 < occlusion.max()  # the knot hides some of itself
    expected = scene.exposure * np.array(scene.material.diffuse) * occlusion[:, None]
    np.testing.assert_allclose(found["image"][..., :3][inside], expected, rtol=1e-5)


@pytest.mark.gl
def test_a_lambertian_picture_is_the_same_from_wherever_it_is_looked_at() -> None:
    """A sphere's middle faces the camera: with the light there too it shows Kd Id, and nothing glossy beside it."""
    ball = {"object": "sphere:16000", "light.azimuth": 0.0, "light.elevation": 8.0, "light.ambient": [0.0, 0.0, 0.0]}
    scene = preset("lambertian", **ball, **{"lights.0.diffuse": [0, 0, 0], "lights.0.ambient": [0, 0, 0]})
    image = Renderer().render(scene).image
    expected = scene.exposure * np.array(scene.material.diffuse)
    np.testing.assert_allclose(image[30:34, 30:34, :3].mean(axis=(0, 1)), expected, rtol=5e-3)
    across = image[32, :, 0][image[32, :, 3] > 0.99]
    assert np.all(np.diff(across[len(across) // 2 :]) <= 1e-6)  # falls to the rim: no rim glows, no second highlight


def test_fields_set_beside_a_kind_come_after_it(tmp_path: Path) -> None:
    table = '[[control]]\nlabel = "opaque"\nkind = "lambertian"\nset = { material.backlight = 0.5 }\n'
    (only,) = stimuli_of(load(tmp_path, f'title = "x"\n{table}'))
    assert only.scene is not None
    assert (only.scene.material.backlight, only.scene.material.diffuse_contribution) == (0.5, 1.0)
