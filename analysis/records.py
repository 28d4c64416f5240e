"""What was analysed as tables for machines: tables/*.csv and results.json."""

from collections.abc import Iterable
from typing import Any

import pandas as pd

from analysis.results import METHODS, Analysed
from analysis.wording import thesis_verdict


def anova_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """A row per analysis: the `anova` part of results.json."""
    return pd.DataFrame([anova_entry(each) for each in found])


def anova_entry(each: Analysed) -> dict[str, Any]:
    """Question, factor, method and, where they have a value, the statistics."""
    entry: dict[str, Any] = {**heading(each), "kind": each.row.kind}
    if each.anova is None:
        nothing = ("F", "df1", "df2", "p", "effect_size", "ci")
        return {**entry, **dict.fromkeys(nothing), "reason": each.trouble[0]}
    name, size, low, high = each.effect
    entry |= {"F": each.anova["F"], "df1": int(each.anova["df1"]), "df2": int(each.anova["df2"]), "p": each.anova["p"]}
    entry |= {"effect_size": size, "ci": [low, high], "effect_size_name": name, "mse": each.mse, "n": list(each.n)}
    if each.mode == "repeated":
        keys = ("epsilon_gg", "p_gg", "epsilon_hf", "p_hf", "mauchly_w", "mauchly_p", "partial_eta_squared", "dropped")
        entry |= {key: each.anova[key] for key in keys}
    return entry


def heading(each: Analysed) -> dict[str, Any]:
    """What a row of any table is about."""
    return {"question": each.row.question, "factor": each.row.name, "method": METHODS[each.mode]}


def tests_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """A row per test of the default mode, with its p adjusted over the declared family."""
    entries = []
    for each in found:
        if each.anova is None:
            continue
        name, size, low, high = each.effect
        df1, df2 = each.df
        entry = {**heading(each), "kind": each.row.kind, "F": each.anova["F"], "df1": df1, "df2": df2}
        if each.mode == "repeated":
            entry |= {key: each.anova[key] for key in ("epsilon_gg", "epsilon_hf")}
        entry |= {"p": each.p, "p_holm": each.p_holm, "p_fdr": each.p_fdr}
        entries.append(entry | {name: size, "ci_low": low, "ci_high": high})
    return pd.DataFrame(entries)


def contrasts_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """Paired t tests of the declared pairs of samples."""
    parts = [with_labels(each, each.contrasts) for each in found if each.contrasts is not None]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def with_labels(each: Analysed, table: pd.DataFrame) -> pd.DataFrame:
    """The pairs by what the samples show, under their question and factor."""
    labels = {level.code: level.label for level in each.row.levels}
    samples = table["a"].astype(str) + " vs " + table["b"].astype(str)
    shown = table.assign(a=table["a"].map(labels), b=table["b"].map(labels), samples=samples)
    for name, value in reversed(heading(each).items()):
        shown.insert(0, name, value)
    return shown


def simple_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """The simple effects of every interaction."""
    parts = []
    for each in found:
        if each.simple is not None:
            part = each.simple.copy()
            part.insert(0, "interaction", each.row.name)
            part.insert(0, "question", each.row.question)
            parts.append(part)
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def tukey_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """A row per pair of samples: the `tukey` part of results.json."""
    parts = [pairs_of(each, each.tukey) for each in found if each.tukey is not None]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def pairs_of(each: Analysed, table: pd.DataFrame) -> pd.DataFrame:
    """The pairs of one analysis, by picture (or level) and by sample; 500 pictures have 124,750, so by column."""
    key = {level.code: level.stimuli[0] if len(level.stimuli) == 1 else level.label for level in each.row.levels}
    a, b = list(table["a"]), list(table["b"])
    limits = (table[name].tolist() for name in ("difference", "critical_05", "critical_01"))
    return pd.DataFrame(
        {
            **heading(each),
            "a": [key[code] for code in a],
            "b": [key[code] for code in b],
            "samples": [f"{first} vs {second}" for first, second in zip(a, b, strict=True)],
            **{name: table[name] for name in ("difference", "q", "p", "ci_low", "ci_high")},
            "verdict": [thesis_verdict(*pair) for pair in zip(*limits, strict=True)],
        }
    )


def hsd_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """The unrounded HSD of each analysis: the `hsd` part of results.json."""
    return pd.DataFrame(
        [{**heading(each), "hsd_05": hsd[0], "hsd_01": hsd[1]} for each in found if (hsd := each.hsd) is not None]
    )


def means_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """Mean, interval, SD and n of every sample."""
    parts = []
    for each in found:
        if each.means is None:
            continue
        labels = {level.code: level.label for level in each.row.levels}
        part = each.means.rename(columns={"level": "sample"})
        part.insert(0, "label", part["sample"].map(labels))
        for name, value in reversed(heading(each).items()):
            part.insert(0, name, value)
        parts.append(part)
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()
