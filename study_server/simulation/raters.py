"""Raters of known effects: what a person answers is an intercept, the factors' effects, a person term and noise.

    answer = round(intercept + sum of effects of the picture's levels + person + noise), clipped to 1 .. scale

`person` is drawn once for each rater and question, `noise` for each answer, both normal. It is not a model of how
people use a scale: no anchoring, no fatigue, no learning, no order effects. `simulation.crowd` draws from the same
model for many raters at once.
"""

import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from fakesss.problem import BadInput, Strict, nearest, validated
from study_server.manifest import BuiltStudy, Stimulus
from study_server.settings import Question

Steps = Annotated[float, Field(ge=-1000, le=1000)]  # a hundred scales: beyond it float32 has no answer
Share = Annotated[float, Field(ge=0, le=1)]
Spread = Annotated[float, Field(ge=0, le=1000)]


class QuestionEffects(Strict):
    """What moves the answers to one question, in steps of its scale. Factors go by their name or their path."""

    intercept: Steps | None = Field(None, description="mean answer without effects; empty: the scale's middle")
    slopes: dict[str, Steps] = Field({}, description="factor -> steps per standard deviation of its levels")
    levels: dict[str, dict[str, Steps]] = Field({}, description="factor -> level -> steps; levels left out: 0")
    pictures: dict[str, Steps] = Field(
        {}, description="stimulus id -> steps: what no factor says, such as an interaction or a picture made elsewhere"
    )


class Effects(Strict):
    """The effects file: spreads, manners, and a table a question. Manners change no answer, only how it is given."""

    person_sd: Spread = Field(0.7, description="standard deviation of the person term, steps")
    noise_sd: Spread = Field(0.9, description="standard deviation of the noise, steps")
    slow: Share = Field(0.1, description="share of raters who take three times as long")
    clumsy: Share = Field(
        0.1, description="share of raters who mistype and correct, send twice, reload, and overlook instructed items"
    )
    question: dict[str, QuestionEffects] = Field({}, description="question -> its effects")


THESIS = Effects(
    question={
        "translucent": QuestionEffects(
            slopes={"material.thickness_exponent": 0.75, "material.backlight": -0.6},
            levels={"material.diffuse_weight": {"0": -1.2}},
        ),
        "realistic": QuestionEffects(slopes={"material.thickness_exponent": -0.45}),
    }
)
"""Directions found by Gascons (2011), section 4.2: a larger exponent looks more translucent and slightly less
realistic, more backlight and no diffuse weight look less translucent. The sizes are ours."""


def load_effects(path: Path, study: BuiltStudy) -> Effects:
    """The effects in a TOML file, checked against the study.

    Raises `BadInput` naming file, key and the nearest question, factor or level of the study.
    """
    try:
        effects = validated(Effects, tomllib.loads(path.read_text(encoding="utf-8")), str(path))
    except OSError as error:
        raise BadInput(f"{path}: cannot be read ({error.strerror}); give another file with --effects") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: is not TOML ({error}); mend that line") from None
    questions = [question.name for question in study.settings.question]
    for name, of_question in effects.question.items():
        if name not in questions:
            raise BadInput(f"{path}: question.{name}: the study asks no such question; {nearest(name, questions)}")
        check_factors(of_question, study, f"{path}: question.{name}")
        for picture in of_question.pictures:
            if picture not in study.by_id:
                raise BadInput(
                    f'{path}: question.{name}.pictures: "{picture}" is no picture of the study; '
                    f"{nearest(picture, study.by_id)}"
                )
    return effects


def check_factors(effects: QuestionEffects, study: BuiltStudy, where: str) -> None:
    """`BadInput` if a factor or level is not of the study, or a slope is asked of levels that are not numbers."""
    known = factors_by_name(study)
    for name in [*effects.slopes, *effects.levels]:
        if name not in known:
            raise BadInput(f'{where}: "{name}" is no factor of the study; {nearest(name, known)}')
    for table, names in (("slopes", effects.slopes), ("levels", effects.levels)):
        refuse_aliases(names, lambda name: known[name]["name"], f"{where}.{table}")
    for name in effects.slopes:
        if not all(isinstance(level, int | float) for level in known[name]["levels"]):
            raise BadInput(f'{where}.slopes: the levels of "{name}" are not numbers; use levels instead')
    for name, shifts in effects.levels.items():
        refuse_aliases(shifts, level_key, f'{where}.levels."{name}"')
        levels = [level_key(level) for level in known[name]["levels"]]
        for level in shifts:
            if level_key(level) not in levels:
                raise BadInput(f'{where}.levels."{name}": "{level}" is no level of it; {nearest(level, levels)}')


def refuse_aliases(names: Iterable[str], meant: Callable[[str], str], where: str) -> None:
    """`BadInput` if two of `names` mean the same: their effects would be added without a word."""
    seen: dict[str, str] = {}
    for name in names:
        other = seen.setdefault(meant(name), name)
        if other != name:
            raise BadInput(f'{where}: "{other}" and "{name}" are the same; keep one of them')


def default_effects(study: BuiltStudy) -> Effects:
    """`THESIS`, as far as the study has its questions and factors."""
    known = factors_by_name(study)
    asked = {question.name for question in study.settings.question}
    kept = {
        name: QuestionEffects(
            slopes={factor: slope for factor, slope in of_question.slopes.items() if factor in known},
            levels={factor: shifts for factor, shifts in of_question.levels.items() if factor in known},
        )
        for name, of_question in THESIS.question.items()
        if name in asked
    }
    return THESIS.model_copy(update={"question": kept})


def factors_by_name(study: BuiltStudy) -> dict[str, Mapping[str, Any]]:
    """The study's factors by name and by path."""
    return {factor[key]: factor for factor in study.factors for key in ("name", "path") if key in factor}


def level_key(level: Any) -> str:
    """A level as text that is the same for 0, 0.0 and "0"."""
    try:
        return f"{float(level):.12g}"
    except (TypeError, ValueError):
        return str(level)


def shift(effects: QuestionEffects, study: BuiltStudy, stimulus: Stimulus) -> float:
    """The sum of the effects of this picture's levels and its own, in steps."""
    known = factors_by_name(study)
    given = stimulus.facts.get("factors") or {}
    total = effects.pictures.get(stimulus.id, 0.0)
    for name, slope in effects.slopes.items():
        factor = known[name]
        if factor["name"] in given:
            total += slope * standardised(given[factor["name"]], factor["levels"])
    for name, shifts in effects.levels.items():
        level = level_key(given.get(known[name]["name"]))
        total += sum(steps for key, steps in shifts.items() if level_key(key) == level)
    return total


def standardised(level: float, levels: list[float]) -> float:
    """(level - mean of levels) / population standard deviation of levels; 0 if there is only one."""
    spread = float(np.std(levels))
    return (level - float(np.mean(levels))) / spread if spread else 0.0


def expected(effects: Effects, study: BuiltStudy, question: Question, stimulus: Stimulus) -> float:
    """Intercept and effects for this picture, in steps: what is answered without person, noise, rounding and clipping.

    A question without effects is answered at the middle of its scale.
    """
    of_question = effects.question.get(question.name, QuestionEffects())
    middle = (1 + question.scale) / 2
    intercept = middle if of_question.intercept is None else of_question.intercept
    return intercept + shift(of_question, study, stimulus)


@dataclass(frozen=True)
class Rater:
    """One simulated person. Answers depend on seed, number, picture and question alone.

    Not on the picture's place in the session: who gets which order depends on who comes first, and the same seed must
    give the same data.
    """

    study: BuiltStudy
    effects: Effects
    seed: int
    number: int

    def rating(self, stimulus: Stimulus, question: str) -> int:
        """The answer to the question of that name for a picture: 1 .. scale."""
        index, asked = next(pair for pair in enumerate(self.study.settings.question) if pair[1].name == question)
        person = self.effects.person_sd * self.random(1, index).standard_normal()
        picture = self.study.stimuli.index(stimulus)
        noise = self.effects.noise_sd * self.random(2, index, picture).standard_normal()
        answer = round(expected(self.effects, self.study, asked, stimulus) + person + noise)
        return min(max(answer, 1), asked.scale)

    @property
    def is_slow(self) -> bool:
        """Whether this rater takes three times as long."""
        return bool(self.random(5).random() < self.effects.slow)

    @property
    def is_clumsy(self) -> bool:
        """Whether this rater mistypes and corrects, sends twice, reloads, and overlooks instructed items."""
        return bool(self.random(6).random() < self.effects.clumsy)

    def random(self, *use: int) -> np.random.Generator:
        """A generator of its own for each use."""
        return np.random.default_rng([self.seed, self.number, *use])
