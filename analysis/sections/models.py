"""Beside the analysis of variance: ordinal regression, mixed models, where variance lies, and whether tests agree."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import pandas as pd

from analysis.evidence import Evidence
from analysis.model_tables import table_of_odds, table_of_shares, table_of_variances, table_of_verdicts
from analysis.models import Modelled, models_of, variance_of
from analysis.plan import AnalysisPlan
from analysis.results import METHODS, Analysed
from analysis.section import Section, rendered
from analysis.statistics.mixed import MixedFit
from analysis.statistics.ordinal import OrdinalFit
from analysis.tables import SHOWN_LEVELS
from analysis.verdicts import agreement_of_tests
from analysis.wording import apa_p, counted, interval, joined, percent, signed, true_minus

TEST = ("chi2", "df", "F", "df2", "p")
KINDS = {"ordinal": "Ordinal regression", "mixed": "Mixed model"}


def models(evidence: Evidence) -> Section | None:
    """Every model that the plan asks for, and the verdict of all tests side by side."""
    fitted, plan = models_of(evidence), evidence.plan
    agreement = agreement_of_tests(fitted, plan.alpha, adjusted=plan.adjust != "none")
    shares, no_shares = variance_of(evidence)
    tables = {
        "ordinal": ordinal_table(fitted),
        "odds_ratios": odds_table(fitted),
        "mixed": mixed_table(fitted),
        "variance": shares,
    }
    warnings = [*cautions(fitted), *(f"Variance of {question}: {why}." for question, why in no_shares.items())]
    if not agreement and all(table.empty for table in tables.values()) and not warnings:
        return None
    body = rendered(
        "models",
        repeated=evidence.sample.mode == "repeated",
        agreement=agreement,
        verdicts=table_of_verdicts(fitted, plan.alpha),
        odds=table_of_odds(tables["odds_ratios"], fitted, plan.confidence),
        variances=table_of_variances(fitted),
        shares=table_of_shares(shares),
    )
    said = [apa_ordinal(model, each, test, plan) for model, each, test in ordinal_tests(fitted)]
    summary = [sentence for sentence in (agreement, share_sentence(shares)) if sentence]
    tables = {name: table for name, table in tables.items() if not table.empty}
    return Section(
        "models", "Models, and whether the tests agree", body, tables, (), tuple(summary), tuple(said), tuple(warnings)
    )


def ordinal_tests(fitted: Sequence[Modelled]) -> Iterator[tuple[Modelled, Analysed, dict[str, Any]]]:
    """Every row with an ordinal test."""
    for model in fitted:
        for each in model.found:
            test = model.test(model.ordinal, each)
            if test is not None:
                yield model, each, test


def place_of(each: Analysed) -> dict[str, str]:
    """Question, factor and method: what every table of the report begins with."""
    return {"question": each.row.question, "factor": each.row.name, "method": METHODS[each.mode]}


def table_of_kind(fitted: Sequence[Modelled], kind: str, facts: Callable[[Any], dict[str, Any]]) -> pd.DataFrame:
    """Every row's test by one kind of model with the `facts` of its fit, or the `reason` why it has none."""
    rows: list[dict[str, Any]] = []
    for model in fitted:
        for each in model.found:
            fit = getattr(model, kind)
            test = model.test(fit, each)
            if test is not None:
                rows.append({**place_of(each), **{key: test[key] for key in TEST}, **facts(fit)})
            elif kind in model.missing:
                rows.append({**place_of(each), "reason": model.missing[kind]})
    return pd.DataFrame(rows)


def ordinal_table(fitted: Sequence[Modelled]) -> pd.DataFrame:
    """`chi2, df, F, df2, p, n, participants, log_likelihood` of each row, or the `reason` why it has none."""

    def facts(fit: OrdinalFit) -> dict[str, Any]:
        return {"n": fit.n, "participants": fit.clusters or None, "log_likelihood": fit.log_likelihood, "reason": ""}

    return table_of_kind(fitted, "ordinal", facts)


def odds_table(fitted: Sequence[Modelled]) -> pd.DataFrame:
    """`level, against, odds_ratio, ci_low, ci_high, log_odds, se` of every level but each factor's first."""
    rows = []
    for model in fitted:
        for entry in model.ordinal.odds_ratios.to_dict("records") if model.ordinal else ():
            each = next(one for one in model.found if one.row.name == entry["factor"])
            keys = ("level", "against", "odds_ratio", "ci_low", "ci_high", "log_odds", "se")
            rows.append({**place_of(each), **{key: entry[key] for key in keys}})
    return pd.DataFrame(rows)


def mixed_table(fitted: Sequence[Modelled]) -> pd.DataFrame:
    """`chi2, df, F, df2, p, n`, the model's variances and what it lacks, of each row; or `reason`: why it has none."""

    def facts(fit: MixedFit) -> dict[str, Any]:
        parts = dict(fit.variances[["term", "variance"]].itertuples(index=False, name=None))
        variances = {f"variance_{name}": value for name, value in parts.items()}
        return {"n": fit.n, **variances, "left_out": "; ".join(fit.left_out), "at_zero": "; ".join(fit.at_zero)}

    return table_of_kind(fitted, "mixed", facts)


def cautions(fitted: Sequence[Modelled]) -> list[str]:
    """Models without a value, variances at 0, few clusters: a sentence for each cause, with the rows it is about."""
    said: dict[tuple[str, str], list[str]] = {}
    for model in fitted:
        causes = [(KINDS[kind], why) for kind, why in model.missing.items() if kind not in model.by_design]
        if model.ordinal:
            causes += [(KINDS["ordinal"], why) for why in model.ordinal.cautions]
        if model.mixed:
            zero = (f"the variance of {name}s is 0; fitted without it" for name in model.mixed.at_zero)
            causes += [(KINDS["mixed"], why) for why in zero]
        for cause in causes:
            said.setdefault(cause, []).append(title_of(model))
    return [f"{kind}, {joined(titles)}: {why}." for (kind, why), titles in said.items()]


def title_of(model: Modelled) -> str:
    """The row's title; of a factorial its largest interaction's."""
    return model.found[-1].row.title


def share_sentence(shares: pd.DataFrame) -> str:
    """How much of what we see lies in the picture."""
    if shares.empty:
        return ""
    parts = []
    for question, part in shares.groupby("question", sort=False):
        share = dict(zip(part["term"], part["share"], strict=True))
        parts.append(
            f"{question} {share['picture']:.0%} in the pictures, {share['participant']:.0%} in people and "
            f"{share['residual']:.0%} in neither"
        )
    return f"Where the ratings' variance lies: {'; '.join(parts)}."


def apa_ordinal(model: Modelled, each: Analysed, test: dict[str, Any], plan: AnalysisPlan) -> str:
    """A sentence to paste into a paper."""
    fit = model.ordinal
    assert fit is not None
    errors = f"participant-clustered standard errors, {counted(fit.clusters, 'participant')}, " if fit.clusters else ""
    verdict = "a significant effect" if test["p"] < plan.alpha else "no significant effect"
    what = "picture" if each.row.kind in ("comparison", "all") else each.row.name
    where = f" ({each.row.compared})" if each.row.kind == "comparison" else ""
    return (
        f"A proportional odds regression ({errors}{counted(fit.n, 'rating')}) showed {verdict} of {what} on ratings of "
        f"“{each.row.question}”{where}, {statistic_text(test)}, {apa_p(test['p'])}"
        f"{odds_in_words(fit.odds_ratios, each.row.name, plan.confidence)}."
    )


def statistic_text(test: Mapping[str, Any]) -> str:
    """F of clustered errors, chi-squared of independent answers."""
    if pd.isna(test["F"]):
        return f"χ²({test['df']}) = {test['chi2']:.2f}"
    return f"F({test['df']}, {test['df2']:.0f}) = {test['F']:.2f}"


def odds_in_words(odds: pd.DataFrame, factor: str, confidence: float) -> str:
    """Each level's odds ratio with its interval; empty for interactions, and where there are many levels."""
    mine = odds[odds["factor"] == factor]
    if mine.empty or len(mine) >= SHOWN_LEVELS:
        return ""
    cells = [
        f"{true_minus(str(row['level']))}: OR = {signed(row['odds_ratio'])}, {percent(confidence)} CI "
        f"{interval(row['ci_low'], row['ci_high'])}"
        for row in mine.to_dict("records")
    ]
    return f" (against {true_minus(str(mine['against'].iloc[0]))}: {'; '.join(cells)})"
