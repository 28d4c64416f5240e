"""What will be tested, written before the data: the `[analysis]` table of study.toml."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from fakesss.problem import BadInput, Strict, nearest, validated

Mode = Literal["repeated", "independent"]
Share = Annotated[float, Field(gt=0, le=1)]
Level = Annotated[float, Field(gt=0, lt=1)]
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


class AnalysisPlan(Strict):
    """The declared analysis of a study."""

    alpha: Level = Field(0.05, description="significance level; the thesis used 0.10")
    mode: Literal["auto", "repeated", "independent"] = Field(
        "auto", description="auto: repeated measures when participants rated every picture, else independent samples"
    )
    confidence: Level = Field(0.95, description="confidence level of intervals of means and differences")
    completers_only: bool = Field(True, description="analyse only participants who rated everything they were shown")
    exclude: Exclusions = Field(Exclusions(), description="rules for leaving participants out")
    comparison: tuple[Comparison, ...] = Field((), description="pictures compared beside the factors' rows")

    @model_validator(mode="after")
    def named_once(self) -> "AnalysisPlan":
        """Two comparisons of one name and question could not be told apart in the tables."""
        names = [(entry.name, entry.question) for entry in self.comparison]
        twice = next((pair for pair in names if names.count(pair) > 1), None)
        if twice is not None:
            raise ValueError(f'comparison "{twice[0]}" of question "{twice[1]}" stands twice; rename one')
        return self


def check_analysis(study_table: Mapping[str, Any], source: str) -> AnalysisPlan:
    """The plan in a study's `[analysis]` table (defaults where there is none).

    `study_table` is study.toml as read; `source` names it in messages. Raises `BadInput` for an unknown key, a value
    out of range, or a comparison on a question that the study does not ask.
    """
    table = study_table.get("analysis", {})
    if not isinstance(table, Mapping):
        raise BadInput(f"{source}: analysis: must be a table; write [analysis]")
    plan = validated(AnalysisPlan, table, f"{source}: [analysis]")
    asked = [str(entry["name"]) for entry in study_table.get("question", []) if "name" in entry]
    for entry in plan.comparison:
        if asked and entry.question not in asked:
            raise BadInput(
                f'{source}: [analysis] comparison "{entry.name}": question "{entry.question}" is not asked; '
                f"{nearest(entry.question, asked)}"
            )
    return plan
