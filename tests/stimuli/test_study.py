"""`study.toml`: what is accepted, and the one sentence for what is not."""

from pathlib import Path

import pytest

from fakesss.problem import BadInput
from stimuli.design import stimuli_of
from stimuli.study import Study
from stimuli.template import template_names, write_template

FACTOR = '[[factor]]\nname = "thickness"\npath = "material.thickness_exponent"\nlevels = [25, 18]\n'


def load(folder: Path, text: str) -> Study:
    (folder / "study.toml").write_text(text, encoding="utf-8")
    return Study.load(folder)


@pytest.mark.parametrize("name", template_names())
def test_templates_are_valid_studies(tmp_path: Path, name: str) -> None:
    write_template(tmp_path / "new", name)
    assert Study.load(tmp_path / "new").factor


def test_a_template_never_overwrites(tmp_path: Path) -> None:
    write_template(tmp_path, "thesis")
    with pytest.raises(BadInput, match=r"study\.toml: exists already"):
        write_template(tmp_path, "minimal")


def test_an_unknown_template_names_the_nearest(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match='did you mean "thesis"'):
        write_template(tmp_path, "theses")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (f'titel = "x"\n{FACTOR}', 'study.toml: titel: unknown key; did you mean "title"?'),
        (FACTOR, "study.toml: title: is missing; add it"),
        (
            f'title = "x"\n[scene.materal]\nbacklight = 1\n{FACTOR}',
            'study.toml: scene.materal: unknown key; did you mean "material"?',
        ),
        (
            f'title = "x"\n[scene.material]\nbacklihgt = 1\n{FACTOR}',
            'study.toml: scene.material.backlihgt: unknown key; did you mean "backlight"?',
        ),
        (
            'title = "x"\n' + FACTOR.replace("18", "-3"),
            'study.toml: factor "thickness": level -3: must be >= 0',
        ),
        (
            'title = "x"\n' + FACTOR.replace("thickness_exponent", "thicknes_exponent"),
            'study.toml: factor "thickness": path "material.thicknes_exponent" is no scene field; '
            'did you mean "material.thickness_exponent"?',
        ),
        ('title = "x"\n' + FACTOR.replace("18", "25"), 'study.toml: factor "thickness": level 25 stands twice'),
        ('title = "x"\n' + FACTOR + FACTOR, 'study.toml: factor name "thickness" is used twice'),
        ('title = "x"\nseed = true\n' + FACTOR, "study.toml: seed: True: must be a valid integer"),
        ('title = "x"\n' + FACTOR.replace("levels", "level"), "study.toml: factor[1].level: unknown key"),
        (
            'title = "x"\n[design]\nkind = "latin"\n' + FACTOR,
            "study.toml: design.kind: 'latin': must be 'one-at-a-time'",
        ),
        ('title = "x"\n' + FACTOR.replace("18", '"18"'), "level '18': must be a valid number"),
        ('title = "x"\n' + FACTOR.replace("18", "true"), "level True: must be a valid number"),
        ('title = "x"\n' + FACTOR.replace("[25, 18]", "[]"), "must be a list of at least one level"),
        ('title = "x"\n' + FACTOR.replace("18", "inf"), "level inf must be a finite number"),
        ('title = "x"\n' + FACTOR.replace("18", "1979-05-27"), "level '1979-05-27': must be a valid number"),
        ('title = "x"\n' + FACTOR.replace('"thickness"', '"=thickness"'), "would be a formula in a spreadsheet"),
        (
            'title = "x"\n[[scene.lights]]\n[[factor]]\nname = "fill"\npath = "lights.1.azimuth"\nlevels = [0, 90]\n',
            'factor "fill": path "lights.1.azimuth": counts from lights.0, and the scene has 1 of them',
        ),
        ('title = "x"\n', "study.toml: nothing to show: add a [[factor]]"),
        ('title = "x\n', "not valid TOML"),
    ],
)
def test_bad_input_gets_one_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    with pytest.raises(BadInput) as caught:
        load(tmp_path, text)
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_no_study_file_says_how_to_make_one(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="make one with `fakesss new"):
        Study.load(tmp_path)


def test_a_factor_may_vary_a_further_light(tmp_path: Path) -> None:
    factor = '[[factor]]\nname = "fill"\npath = "lights.0.diffuse"\nlevels = [[0, 0, 0], [0.5, 0.5, 1]]\n'
    study = load(tmp_path, f'title = "x"\n[[scene.lights]]\nkind = "spot"\n{factor}')
    scenes = {one.scene.lights[0].diffuse for one in stimuli_of(study) if one.scene}
    assert scenes == {(0, 0, 0), (0.5, 0.5, 1)}
