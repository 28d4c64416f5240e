"""`study.toml`: what is accepted, and the one sentence for what is not."""

from pathlib import Path

import pytest

from fakesss.problem import BadInput
from stimuli.design import stimuli_of
from stimuli.sources import check_sources
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
        (
            'title = "x"\n' + FACTOR.replace("18", '"18"'),
            'study.toml: factor "thickness": level "18": must be a valid number',
        ),
        ('title = "x"\n' + FACTOR.replace("18", "true"), "level true: must be a valid number"),
        (
            'title = "x"\n' + FACTOR.replace("[25, 18]", "[]"),
            'factor "thickness": levels []: must be a list of at least one',
        ),
        ('title = "x"\n' + FACTOR.replace("18", "inf"), 'factor "thickness": level inf: must be a finite number'),
        (
            'title = "x"\n' + FACTOR.replace("18", "1979-05-27"),
            "level 1979-05-27: must be a finite number, true or false, a word",
        ),
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


LIT = 'title = "x"\n[design]\nkind = "full-factorial"\n[[scene.lights]]\n[[factor]]\nname = "f"\npath = '


@pytest.mark.parametrize(
    ("factor", "sentence"),
    [
        (
            '"lights.0.diffuse"\nlevels = [["1", "1", "1"]]',
            'level ["1", "1", "1"]: must be a finite number, true or false, a word, or a list of numbers',
        ),
        ('"lights.0.diffuse"\nlevels = [[1, true, 1]]', "level [1, true, 1]: must be a finite number, true"),
        ('"lights.0.diffuse"\nlevels = [[1, 1]]', "level [1, 1]: lights.0.diffuse[3]: is missing; add it"),
        ('"lights.0.diffuse"\nlevels = [[1, 1, 1, 1]]', "level [1, 1, 1, 1]: must have at most 3 items, not 4"),
        ('"lights.0.diffuse"\nlevels = [[1, -1, 1]]', "level [1, -1, 1]: lights.0.diffuse[2]: -1: must be >= 0"),
        ('"lights.0.attenuation"\nlevels = [[0, 0, 0]]', "level [0, 0, 0]: lights.0: attenuation (0, 0, 0) divides"),
        ('"lights.0.kind"\nlevels = ["a: b"]', "level \"a: b\": must be 'directional', 'point' or 'spot'"),
        ('"lights.0.azimuth"\nlevels = 5', "levels 5: must be a list of at least one"),
        ('"camera.near"\nlevels = [1.0, 1.0]', "level 1.0 stands twice; remove one"),
        ('"alpha"\nlevels = [false, true]', "level true: a browser would show its page through the picture; set alpha"),
    ],
)
def test_a_level_that_cannot_be_is_named_as_it_is_written(tmp_path: Path, factor: str, sentence: str) -> None:
    with pytest.raises(BadInput) as caught:
        load(tmp_path, f"{LIT}{factor}\n")
    assert str(caught.value).startswith(f'study.toml: factor "f": {sentence}')


def test_levels_that_do_not_go_together_are_named(tmp_path: Path) -> None:
    far = '[[factor]]\nname = "far"\npath = "camera.far"\nlevels = [3, 1.5]\n'
    study = load(tmp_path, f'{LIT}"camera.near"\nlevels = [1, 2]\n{far}')
    with pytest.raises(BadInput) as caught:
        stimuli_of(study)
    assert str(caught.value) == (
        'study.toml: factor "f" level 2, factor "far" level 1.5: camera: near 2.0 must be < far 1.5'
    )


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ('[scene]\nobject = "shpere"\n' + FACTOR, 'scene.object "shpere": object "shpere": is neither'),
        (
            '[[factor]]\nname = "o"\npath = "object"\nlevels = ["sphere", "a.ply"]\n',
            'factor "o": level "a.ply": cannot be read (No such file or directory); check the file\'s name',
        ),
        ('[[compare]]\nimage = "b.png"\n', 'compare "b.png": cannot be read (No such file or directory); check'),
    ],
)
def test_what_pictures_are_made_from_is_looked_for_and_its_place_named(tmp_path: Path, text: str, place: str) -> None:
    study = load(tmp_path, f'title = "x"\n{text}')
    with pytest.raises(BadInput) as caught:
        check_sources(study, stimuli_of(study), tmp_path)
    assert str(caught.value).startswith(f"study.toml: {place}")
