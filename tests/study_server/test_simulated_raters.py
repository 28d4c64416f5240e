"""Simulated raters do what they were told: their effects, their number, their leaving."""

import json
from collections.abc import Callable
from pathlib import Path

import httpx
import numpy as np
import pytest
from click.testing import CliRunner
from study_fixture import write_study
from survey_client import Participant

import fakesss.cli_study  # noqa: F401  (adds the command)
from fakesss.cli import commands
from fakesss.problem import BadInput
from study_server.app import admin_secret
from study_server.exports.export import mode_to_analyse
from study_server.manifest import BuiltStudy, load_study
from study_server.serve import served
from study_server.simulation import walk
from study_server.simulation.raters import Effects, QuestionEffects, Rater, default_effects, load_effects, shift
from study_server.simulation.simulate import completing, quitting, simulate
from study_server.site import Mode

Exported = Callable[..., list[dict[str, str]]]


@pytest.fixture
def built(tmp_path: Path) -> BuiltStudy:
    return load_study(write_study(tmp_path / "nine", 9))


def test_a_simulation_loses_and_doubles_nothing(url: str, study: Path, exported: Exported) -> None:
    result = simulate(url, load_study(study), admin_secret(study), started=7, completed=5, seed=2, progress=False)
    assert list(result) == [
        "started", "completed", "acknowledged", "stored", "lost", "duplicated", "p50_ms", "p99_ms", "base_url"
    ]  # fmt: skip
    assert (result["started"], result["completed"], result["lost"], result["duplicated"]) == (7, 5, 0, 0)
    assert result["acknowledged"] == result["stored"] == sum(row["rating"] != "" for row in exported(mode="simulated"))
    assert sum(person["status"] == "finished" for person in exported("participants", "simulated")) == 5
    assert 0 < result["p50_ms"] <= result["p99_ms"]


@pytest.mark.parametrize("mode", ["live", "pilot"])
def test_programs_are_never_taken_for_people(study: Path, csv_rows: Exported, mode: Mode) -> None:
    with served(study, mode=mode) as url:
        Participant(url).to_trials().rate()
        simulate(url, load_study(study), admin_secret(study), started=3, completed=2, progress=False)
        headers = {"Accept": "application/json", "Authorization": f"Bearer {admin_secret(study)}"}
        page = httpx.get(f"{url}/admin", headers=headers).json()
        people = csv_rows(study, url, "participants")
        programs = csv_rows(study, url, "ratings", "simulated")
    assert (page["mode"], page["started"], page["ratings"], len(people)) == (mode, 1, 2, 1)
    assert {row["mode"] for row in programs} == {"simulated"}
    assert len({row["session"] for row in programs} - {people[0]["session"]}) == 3


def test_a_second_run_of_the_same_seed_brings_new_people(study: Path, csv_rows: Exported) -> None:
    with served(study, mode="simulated") as url:
        for _ in range(2):
            simulate(url, load_study(study), admin_secret(study), started=3, completed=3, progress=False)
        rows = csv_rows(study, url, "ratings")
    told: dict[str, list[tuple[str, str]]] = {}
    for row in rows:
        told.setdefault(row["session"], []).append((row["question"], row["rt_ms"]))
    assert len({tuple(sorted(answers)) for answers in told.values()}) == 6


def test_a_server_of_another_study_is_left_alone(study: Path, url: str, tmp_path: Path, exported: Exported) -> None:
    other = load_study(write_study(tmp_path / "other", 9))
    with pytest.raises(BadInput, match=f"^{url}: serves another study than .*other"):
        simulate(url, other, admin_secret(study), started=1, completed=1, progress=False)
    assert exported("participants", "simulated") == []


@pytest.mark.parametrize(
    "address", ["127.0.0.1:8000", "localhost:8000", "nothing", "", "ftp://x", "http://", "http://x:y"]
)
def test_an_address_that_is_none_is_said_at_once(study: Path, address: str) -> None:
    with pytest.raises(BadInput, match=r"is no address.*write http://HOST:PORT"):
        simulate(address, load_study(study), "", started=1, completed=1, progress=False)


def test_exactly_as_many_stay_as_asked() -> None:
    quits = quitting(44, 38, 9, seed=1)
    assert quits.count(None) == 38
    assert all(quit_after in range(9) for quit_after in quits if quit_after is not None)
    assert quits != quitting(44, 38, 9, seed=2)


def test_counts_that_make_no_sense(study: Path) -> None:
    with pytest.raises(BadInput, match="--completed 9: must be between 0 and --started 5"):
        simulate("http://127.0.0.1:9", load_study(study), "", started=5, completed=9)


def test_who_says_how_many_begin_need_not_say_how_many_finish(url: str, study: Path) -> None:
    assert [completing(started) for started in (44, 22, 10, 1)] == [38, 19, 9, 1]
    result = CliRunner().invoke(commands, ["simulate", str(study), "--url", url, "--started", "4", "--json"])
    assert result.exit_code == 0, result.exception
    assert (json.loads(result.stdout)["started"], json.loads(result.stdout)["completed"]) == (4, 3)


def test_a_seed_below_zero_is_bad_input(study: Path) -> None:
    result = CliRunner().invoke(commands, ["simulate", str(study), "--seed", "-1"])
    assert (result.exit_code, "x>=0" in result.stderr) == (2, True)


def test_a_page_that_lets_nobody_on_is_said(tmp_path: Path) -> None:
    """It was posted to for ever, as fast as could be."""
    asked = {"name": "hand", "text": "Hand?", "choices": ["left"], "screen_out": ["left"], "required": True}
    study = write_study(tmp_path / "study", survey={"about": [asked]})
    with served(study) as url, pytest.raises(BadInput, match='the page "about" takes no answer and stays'):
        simulate(url, load_study(study), admin_secret(study), started=1, progress=False)


def test_a_server_out_of_reach(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(walk, "PATIENCE_S", 0.2)
    with pytest.raises(BadInput, match="gave no answer"):
        simulate("http://127.0.0.1:9", load_study(study), "", started=1, completed=1, progress=False)


def test_the_same_seed_gives_the_same_answers(built: BuiltStudy) -> None:
    def answers(seed: int, number: int) -> list[int]:
        rater = Rater(built, default_effects(built), seed, number)
        return [rater.rating(stimulus, "translucent") for stimulus in built.stimuli]

    assert answers(1, 2) == answers(1, 2)
    assert len({tuple(answers(seed, number)) for seed in (1, 2) for number in range(4)}) == 8


def test_one_picture_under_two_names_is_judged_afresh_each_time(study: Path, csv_rows: Exported) -> None:
    manifest = study / "stimuli" / "manifest.json"
    data = json.loads(manifest.read_text())
    data["stimuli"][2] |= {"sha256": data["stimuli"][0]["sha256"], "file": data["stimuli"][0]["file"]}
    manifest.write_text(json.dumps(data))
    with served(study, mode="simulated") as url:
        simulate(url, load_study(study), admin_secret(study), started=12, completed=12, progress=False)
        rows = csv_rows(study, url, "ratings")
    names = [stimulus["id"] for stimulus in data["stimuli"]]
    given = {(row["session"], row["question"], row["stimulus"]): row["rating"] for row in rows}
    twins = [
        (rating, given[session, question, names[2]])
        for (session, question, name), rating in given.items()
        if name == names[0]
    ]
    assert any(first != second for first, second in twins)


def test_planted_effects_come_out(built: BuiltStudy) -> None:
    effects = Effects(
        person_sd=0.5,
        noise_sd=0.5,
        question={"translucent": QuestionEffects(levels={"backlight": {"0.8": 1.0, "1.6": -1.0}})},
    )
    raters = [Rater(built, effects, 5, number) for number in range(400)]
    base, more, less = (
        np.mean([rater.rating(built.by_id[name], "translucent") for rater in raters])
        for name in ("img04", "img05", "img06")
    )
    assert more - base == pytest.approx(1.0, abs=0.15)
    assert less - base == pytest.approx(-1.0, abs=0.15)
    assert {rater.rating(built.by_id["img01"], "realistic") for rater in raters} <= set(range(1, 8))


def test_the_defaults_mirror_the_thesis(built: BuiltStudy) -> None:
    of_translucent = default_effects(built).question["translucent"]
    moved = {name: shift(of_translucent, built, stimulus) for name, stimulus in built.by_id.items()}
    assert moved["img02"] < moved["img01"] < moved["img03"]  # exponents 18, 25, 30
    assert moved["img06"] < moved["img04"] < moved["img05"]  # backlights 1.6, 1.2, 0.8
    assert moved["img08"] < moved["img07"] == moved["img09"]  # diffuse weights 0, 0.2, 0.5
    of_realistic = default_effects(built).question["realistic"]
    assert shift(of_realistic, built, built.by_id["img03"]) < shift(of_realistic, built, built.by_id["img02"])


def test_an_effects_file(tmp_path: Path, built: BuiltStudy) -> None:
    path = tmp_path / "effects.toml"
    path.write_text(
        'noise_sd = 0.0\nperson_sd = 0\n[question.translucent]\nintercept = 3\nslopes = {"material.backlight" = -0.5}\n'
        '[question.translucent.levels."thickness exponent"]\n18 = -1\n"30.0" = 2\n'
    )
    effects = load_effects(path, built)
    rater = Rater(built, effects, 1, 1)
    assert [rater.rating(built.by_id[name], "translucent") for name in ("img01", "img02", "img03")] == [3, 2, 5]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("noise = 1", 'noise: unknown key; did you mean "noise_sd"?'),
        ("[question.transluscent]", 'asks no such question; did you mean "translucent"?'),
        (
            "[question.translucent.slopes]\nbacklit = 1",
            '"backlit" is no factor of the study; did you mean "backlight"?',
        ),
        ("[question.translucent.levels.backlight]\n0.9 = 1", "must"),
        ('[question.translucent.levels.backlight]\n"0.9" = 1', '"0.9" is no level of it'),
        (
            '[question.translucent.slopes]\nbacklight = 1\n"material.backlight" = 1',
            'slopes: "backlight" and "material.backlight" are the same; keep one of them',
        ),
        (
            '[question.translucent.levels]\nbacklight = {"0.8" = 1}\n"material.backlight" = {"1.6" = 1}',
            'levels: "backlight" and "material.backlight" are the same',
        ),
        (
            '[question.translucent.levels."diffuse weight"]\n"0" = -1\n"0.0" = -1',
            'levels."diffuse weight": "0" and "0.0" are the same',
        ),
        (
            "[question.translucent.pictures]\nimg99 = 1",
            'pictures: "img99" is no picture of the study; did you mean "img',
        ),
        ("noise_sd = -1", "noise_sd: -1"),
        ("noise_sd =", "is not TOML"),
    ],
)
def test_an_effects_file_that_is_wrong(tmp_path: Path, built: BuiltStudy, text: str, sentence: str) -> None:
    path = tmp_path / "effects.toml"
    path.write_text(text)
    with pytest.raises(BadInput) as problem:
        load_effects(path, built)
    assert sentence in str(problem.value)
    assert str(problem.value).startswith(str(path))


def test_what_a_seed_draws_is_kept(built: BuiltStudy) -> None:
    """Answers published with a seed must come out again, as drawn when effects had no pictures."""
    rater = Rater(built, default_effects(built), 2011, 3)
    assert [
        [rater.rating(stimulus, question) for stimulus in built.stimuli] for question in ("translucent", "realistic")
    ] == [
        [5, 4, 5, 4, 4, 5, 3, 3, 4],
        [5, 4, 4, 6, 2, 2, 3, 4, 5],
    ]


def test_a_picture_has_effects_of_its_own(built: BuiltStudy) -> None:
    own = QuestionEffects(pictures={"img02": 1.5}, slopes={"backlight": -1.0})
    without = QuestionEffects(slopes={"backlight": -1.0})
    moved = [shift(own, built, each) - shift(without, built, each) for each in built.stimuli]
    assert moved == [0, 1.5, *[0] * (len(moved) - 2)]


def test_an_effects_file_that_is_not_there(tmp_path: Path, built: BuiltStudy) -> None:
    with pytest.raises(BadInput, match="cannot be read"):
        load_effects(tmp_path / "none.toml", built)


def test_what_is_analysed_are_live_then_simulated_then_pilot_ratings(study: Path) -> None:
    modes: tuple[Mode, ...] = ("pilot", "simulated", "live")
    before: Mode = "live"
    for mode in modes:
        with served(study, mode=mode) as url:
            person = Participant(url).to_trials()  # a consent and a practice trial are no ratings
            assert mode_to_analyse(study) == before
            person.rate()
        assert mode_to_analyse(study) == mode
        before = mode


def test_a_seed_is_a_data_set_whoever_comes_first(tmp_path: Path, csv_rows: Exported) -> None:
    """Who gets which order is a race; what finishers say of a picture must not be."""
    told = []
    for name in ("one", "two"):
        study = write_study(tmp_path / name)
        with served(study, mode="simulated") as url:
            simulate(url, load_study(study), admin_secret(study), started=8, completed=8, seed=3, progress=False)
            rows = csv_rows(study, url, "ratings")
        people: dict[str, list[tuple[str, str, str]]] = {}
        for row in rows:
            people.setdefault(row["session"], []).append((row["stimulus"], row["question"], row["rating"]))
        told.append(sorted(sorted(answers) for answers in people.values()))
    assert told[0] == told[1]


@pytest.mark.parametrize(
    ("line", "offender"),
    [
        ("noise_sd = 1e39", "noise_sd: 1e+39"),
        ("person_sd = 1001", "person_sd: 1001"),
        ("[question.translucent]\nintercept = 1e300", "question.translucent.intercept: 1e+300"),
        ("[question.translucent.slopes]\nbacklight = 1e300", "question.translucent.slopes.backlight: 1e+300"),
        ("[question.translucent.pictures]\nimg01 = -1e300", "question.translucent.pictures.img01: -1e+300"),
    ],
)
def test_effects_are_bounded(tmp_path: Path, line: str, offender: str) -> None:
    """A thousand steps are more than any scale has, and all that float32 need hold."""
    study = load_study(write_study(tmp_path / "study", 9))
    path = tmp_path / "effects.toml"
    path.write_text(line)
    with pytest.raises(BadInput) as error:
        load_effects(path, study)
    assert offender in str(error.value) and "1000" in str(error.value)
