"""What will be tested, written before the data: the `[analysis]` table of study.toml."""

import math
import tomllib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from analysis.ratings import DEFAULT_SCALE
from fakesss.problem import BadInput, Strict, nearest, validated

Mode = Literal["repeated", "independent"]
Share = Annotated[float, Field(gt=0, le=1)]
Level = Annotated[float, Field(gt=0, lt=1)]
Margin = Annotated[float, Field(gt=0, allow_inf_nan=False)]
BEST = "best"


class Exclusions(Strict):
    """Whose ratings are left out. An empty rule excludes nobody; every exclusion is listed in the report."""

    failed_checks: Annotated[int, Field(ge=1)] | None = Field(
        None, description="leave out who failed at least this many attention checks"
    )
    median_rt_ms_below: Annotated[float, Field(gt=0)] | None = Field(
        None, description="leave out whose median answer time, in milliseconds, is below this"
    )
    same_answer_share: Share | None = Field(
        None, description="leave out who gave one and the same answer in at least this share of the ratings, 0..1"
    )


class Comparison(Strict):
    """Pictures compared with each other on one question: samples M1..Mk in the order given."""

    name: Annotated[str, Field(min_length=1)] = Field(description="heads the table, the figure and the sentence")
    question: str = Field(description="the [[question]] whose ratings are compared")
    stimuli: Annotated[tuple[str, ...], Field(min_length=2)] = Field(
        description='stimulus ids; "best" is the own picture with the highest mean on the question'
    )

    @model_validator(mode="after")
    def each_once(self) -> "Comparison":
        """A picture compared with itself is a slip."""
        twice = next((name for name in self.stimuli if self.stimuli.count(name) > 1), None)
        if twice is not None:
            raise ValueError(f'stimulus "{twice}" stands twice in comparison "{self.name}"; name it once')
        return self


class PlannedContrast(Strict):
    """A weighted sum of pictures' ratings on one question, tested within people against 0."""

    name: Annotated[str, Field(min_length=1)] = Field(description="heads the table and the sentence")
    question: str = Field(description="the [[question]] whose ratings are combined")
    weights: Annotated[dict[str, Annotated[float, Field(allow_inf_nan=False)]], Field(min_length=2)] = Field(
        description="stimulus id -> weight; the weights add up to 0"
    )

    @model_validator(mode="after")
    def a_contrast(self) -> "PlannedContrast":
        """Weights that do not add up to 0 test a mean, not a difference."""
        total = math.fsum(self.weights.values())
        largest = max(map(abs, self.weights.values()))
        if largest == 0 or abs(total) > 1e-9 * largest:
            raise ValueError(
                f'contrast "{self.name}": its weights add up to {total:g}; they must add up to 0, not all 0'
            )
        return self


class EquivalencePlan(Strict):
    """Which difference is too small to matter. Without it nothing is called equivalent."""

    margin: Margin | dict[str, Margin] = Field(
        description="the smallest difference that matters, in steps of the scale: one for all questions or one for each"
    )
    alpha: Annotated[float, Field(gt=0, lt=0.5)] = Field(
        0.05, description="level of each one-sided test, below 0.5; the interval drawn is at 1 - 2 alpha"
    )

    def margin_of(self, question: str) -> float | None:
        """The margin of a question; None where it has none."""
        return self.margin.get(question) if isinstance(self.margin, dict) else self.margin


class AnalysisPlan(Strict):
    """The declared analysis of a study."""

    alpha: Level = Field(0.05, description="significance level; the thesis used 0.10")
    mode: Literal["auto", "repeated", "independent"] = Field(
        "auto", description="auto: repeated measures when participants rated every picture, else independent samples"
    )
    confidence: Level = Field(0.95, description="confidence level of intervals of means and differences")
    completers_only: bool = Field(True, description="analyse only participants who rated everything they were shown")
    tests: tuple[Literal["ranks", "ordinal", "mixed"], ...] = Field(
        ("ranks", "ordinal", "mixed"), description="what is computed beside the analysis of variance"
    )
    contrasts: Literal["all", "reference", "neighbours"] = Field(
        "all", description="which pairs of levels are compared by paired tests: all, each with the first, or in a chain"
    )
    family: Literal["all", "question", "factor"] = Field(
        "all", description="tests whose p values are adjusted together: all, those of a question, or those of a factor"
    )
    adjust: Literal["none", "holm", "fdr"] = Field(
        "holm", description="the adjusted p that decides: none, Holm, or Benjamini-Hochberg"
    )
    equivalence: EquivalencePlan | None = Field(None, description="the margin of equivalence; there is no default")
    exclude: Exclusions = Field(Exclusions(), description="rules for leaving participants out")
    comparison: tuple[Comparison, ...] = Field((), description="pictures compared beside the factors' rows")
    contrast: tuple[PlannedContrast, ...] = Field((), description="planned contrasts of pictures")

    @model_validator(mode="after")
    def named_once(self) -> "AnalysisPlan":
        """Two entries of one name and question could not be told apart in the tables."""
        for kind, entries in (("comparison", self.comparison), ("contrast", self.contrast)):
            names = [(entry.name, entry.question) for entry in entries]
            twice = next((pair for pair in names if names.count(pair) > 1), None)
            if twice is not None:
                raise ValueError(f'{kind} "{twice[0]}" of question "{twice[1]}" stands twice; rename one')
        return self


def read_plan(path: Path) -> AnalysisPlan:
    """The `[analysis]` table of a TOML file of its own, for ratings from elsewhere."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; check the path") from None
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise BadInput(f"{path}: cannot be read as TOML ({error}); see [analysis] in the documentation") from None
    if "analysis" not in table:
        raise BadInput(f"{path}: has no table [analysis]; write one, the plan stands in it")
    return check_analysis(table, str(path))


def check_analysis(study_table: Mapping[str, Any], source: str, pictures: Collection[str] = ()) -> AnalysisPlan:
    """The plan in a study's `[analysis]` table (defaults where there is none).

    `study_table` is study.toml as read; `source` names it in messages; `pictures` are the study's, where they are
    known. Raises `BadInput` for an unknown key, a value out of range, a question that the study does not ask, or a
    picture that it does not have.
    """
    table = study_table.get("analysis", {})
    if not isinstance(table, Mapping):
        raise BadInput(f"{source}: analysis: must be a table; write [analysis]")
    plan = validated(AnalysisPlan, table, f"{source}: [analysis]")
    questions = [entry for entry in study_table.get("question", []) if "name" in entry]
    asked = [str(entry["name"]) for entry in questions]
    named = [(f'comparison "{entry.name}"', entry.question) for entry in plan.comparison]
    named += [(f'contrast "{entry.name}"', entry.question) for entry in plan.contrast]
    if plan.equivalence is not None and isinstance(plan.equivalence.margin, dict):
        named += [("equivalence margin", question) for question in plan.equivalence.margin]
    for where, question in named:
        if asked and question not in asked:
            raise BadInput(
                f'{source}: [analysis] {where}: question "{question}" is not asked; {nearest(question, asked)}'
            )
    refuse_margins(plan, {str(each["name"]): each.get("scale", DEFAULT_SCALE) for each in questions}, source)
    if pictures:
        refuse_unknown_pictures(plan, pictures, source)
    return plan


def refuse_margins(plan: AnalysisPlan, scales: Mapping[str, int | None], source: str) -> None:
    """`BadInput` for a margin that no difference on its question's scale (name -> highest answer) can exceed."""
    for question, scale in scales.items():
        margin = None if plan.equivalence is None else plan.equivalence.margin_of(question)
        if margin is not None and scale is not None and margin >= scale - 1:
            raise BadInput(
                f"{source}: [analysis] equivalence.margin: {margin:g}: must be below {scale - 1}, the length of the "
                f"scale 1 to {scale} of {question}"
            )


def refuse_unknown_pictures(plan: AnalysisPlan, pictures: Collection[str], source: str) -> None:
    """`BadInput` for the first picture of a comparison or a contrast that the study does not have."""
    named = [(f'comparison "{each.name}"', name) for each in plan.comparison for name in each.stimuli if name != BEST]
    named += [(f'contrast "{each.name}"', name) for each in plan.contrast for name in each.weights]
    for where, name in named:
        if name not in pictures:
            known = nearest(name, pictures)
            raise BadInput(f'{source}: [analysis] {where}: the study has no picture "{name}"; {known}')


def margins_not_asked(plan: AnalysisPlan, asked: Collection[str]) -> list[str]:
    """A sentence for each margin of a question that ratings from elsewhere do not answer."""
    margin = None if plan.equivalence is None else plan.equivalence.margin
    strangers = [name for name in margin if name not in asked] if isinstance(margin, dict) else []
    return [f'equivalence margin: question "{name}" is not asked; {nearest(name, asked)}' for name in strangers]
