"""Tables for the page: every cell as it will be read."""

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd
from statsmodels.stats.multitest import multipletests

from analysis.plan import AnalysisPlan
from analysis.results import METHODS, Analysed
from analysis.wording import apa_df, exact_p, no_zero, signed, thesis_hsd, thesis_p, thesis_verdict

SHOWN_LEVELS = 8  # more samples make more pairs than a page should hold: those stand in tables/tukey.csv


@dataclass(frozen=True)
class Table:
    """A table of text: `text_columns` leading columns are words, the others numbers."""

    anchor: str
    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    text_columns: int = 1
    note: str = ""


def table_4_4(found: Sequence[Analysed], plan: AnalysisPlan) -> Table:
    """The thesis's table 4.4 in one mode, with what it leaves out beside it."""
    mode = found[0].mode
    rows = []
    for each in found:
        if each.anova is None:
            rows.append((each.row.title, "no value", *[""] * 5))
            continue
        p = float(each.anova["p"])
        rows.append(
            (
                each.row.title,
                thesis_p(p),
                f"{each.anova['F']:.2f}",
                f"{each.anova['df1']:.0f}, {each.anova['df2']:.0f}",
                sizes_text(each.n),
                f"{each.mse:.3f}",
                exact_p(p),
            )
        )
    return Table(
        f"table-4-4-{mode}",
        f"Table 4.4. Results of the one-way ANOVA, {METHODS[mode]} (significance level {plan.alpha:.0%})",
        ("Configuration", "p-value", "F", "df", "n", "MSE", "p, unrounded"),
        tuple(rows),
        note="p as the thesis's table 4.4 gives it: without correction for sphericity or for the number of tests.",
    )


def sizes_text(sizes: tuple[int, ...]) -> str:
    """One number where all samples have it."""
    return str(sizes[0]) if len(set(sizes)) == 1 else " / ".join(map(str, sizes))


def table_4_5(each: Analysed) -> Table:
    """The thesis's table 4.5 of one comparison."""
    assert each.tukey is not None and each.means is not None
    hsd = each.hsd
    heading = (
        f"HSD[.05] = {thesis_hsd(hsd[0])}; HSD[.01] = {thesis_hsd(hsd[1])}" if hsd else "HSD differs between pairs"
    )
    rows = [
        (
            f"{pair['a']} vs {pair['b']}",
            thesis_verdict(pair["difference"], pair["critical_05"], pair["critical_01"]),
            f"{abs(pair['difference']):.3f}",
            f"{pair['q']:.2f}",
            thesis_p(pair["p"]),
        )
        for pair in each.tukey.to_dict("records")
    ]
    means = dict(zip(each.means["level"], each.means["mean"], strict=True))
    samples = "; ".join(f"{level.code} {level.label} ({means[level.code]:.2f})" for level in each.row.levels)
    first = each.tukey.iloc[0]
    note = f"Means: {samples}. n = {sizes_text(each.n)}, df = {first['df']}, MSE = {first['mse']:.3f}."
    if hsd:
        note += f" Unrounded HSD {hsd[0]:.4f} and {hsd[1]:.4f} decide."
    return Table(
        f"table-4-5-{each.mode}-{each.row.question}",
        f"Table 4.5. Tukey HSD test of {each.row.name} on “{each.row.question}”, {METHODS[each.mode]} ({heading})",
        ("Samples", "P", "|difference|", "q", "p (Tukey)"),
        tuple(rows),
        text_columns=2,
        note=note,
    )


def table_of_tests(found: Sequence[Analysed]) -> Table:
    """The test that fits the design: corrected for sphericity and for the number of tests, with effect size."""
    tested = [each for each in found if each.p is not None]
    holm = multipletests([each.p for each in tested], method="holm")[1] if tested else []
    rows = [test_cells(each, float(adjusted)) for each, adjusted in zip(tested, holm, strict=True)]
    note = f"p Holm: adjusted over the {len(tested)} tests of this table."
    head: tuple[str, ...] = ("Configuration", "F", "df", "p", "p Holm", "η²", "90% CI")
    caption = "One-way ANOVA of independent samples"
    if found and found[0].mode == "repeated":
        head = ("Configuration", "F", "df", "ε GG", "ε HF", "p", "p Holm", "η²G", "90% CI")
        note = f"df and p are Greenhouse–Geisser corrected; ε HF for comparison. η²G: generalized eta squared. {note}"
        caption = "Repeated-measures ANOVA"
    return Table("table-tests", f"{caption}, corrected, with effect sizes", head, tuple(rows), note=note)


def test_cells(each: Analysed, adjusted: float) -> tuple[str, ...]:
    """One line of `table_of_tests`."""
    assert each.anova is not None and each.p is not None
    _, size, low, high = each.effect
    repeated = each.mode == "repeated"
    shrink = each.anova["epsilon_gg"] if repeated else 1.0
    df = f"{apa_df(each.anova['df1'] * shrink)}, {apa_df(each.anova['df2'] * shrink)}"
    epsilons = (f"{shrink:.3f}", f"{each.anova['epsilon_hf']:.3f}") if repeated else ()
    tail = (thesis_p(each.p), thesis_p(adjusted), no_zero(size, 3), f"[{no_zero(low, 3)}, {no_zero(high, 3)}]")
    return (each.row.title, f"{each.anova['F']:.2f}", df, *epsilons, *tail)


def tables_of_ranks(found: Sequence[Analysed]) -> list[Table]:
    """Friedman's test beside the analysis of means, Wilcoxon's where there are two samples; none between people."""
    return [table for table in (table_of_friedman(found), table_of_wilcoxon(found)) if table is not None]


def table_of_wilcoxon(found: Sequence[Analysed]) -> Table | None:
    """Rows of two samples; None where there are none."""
    rows = tuple(
        (
            each.row.title,
            pair_name(each),
            f"{each.wilcoxon['t']:g}",
            f"{each.wilcoxon['n_unequal']:.0f} of {each.wilcoxon['n']:.0f}",
            thesis_p(each.wilcoxon["p"]),
            no_zero(each.wilcoxon["r"], 3),
        )
        for each in found
        if each.wilcoxon is not None
    )
    head = ("Configuration", "Pair", "T", "n unequal", "p", "r")
    note = "T: the smaller sum of ranks. r: rank-biserial correlation, above 0 where the first is rated higher."
    caption = "Wilcoxon’s signed-rank test: ranks of two samples instead of means"
    return Table("table-wilcoxon", caption, head, rows, text_columns=2, note=note) if rows else None


def pair_name(each: Analysed) -> str:
    """The two samples that were rated, of which the second is subtracted."""
    assert each.means is not None
    rated = set(each.means["level"])
    return " minus ".join(level.label for level in each.row.levels if level.code in rated)


def table_of_friedman(found: Sequence[Analysed]) -> Table | None:
    """Rows of three and more samples; None where there are none."""
    rows = tuple(
        (
            each.row.title,
            f"{each.friedman['chi2']:.2f}",
            f"{each.friedman['df']:.0f}",
            thesis_p(each.friedman["p"]),
            no_zero(each.friedman["kendalls_w"], 3),
        )
        for each in found
        if each.friedman is not None
    )
    head = ("Configuration", "χ²", "df", "p", "Kendall W")
    return Table("table-ranks", "Friedman's test: ranks instead of means", head, rows) if rows else None


def table_of_pairs(found: Iterable[Analysed], confidence: float) -> Table | None:
    """Every pair of every row: Tukey's simultaneous intervals; paired t tests (Holm) where people are the same."""
    rows = []
    for each in found:
        if each.tukey is None or len(each.row.levels) > SHOWN_LEVELS:
            continue
        labels = {level.code: level.label for level in each.row.levels}
        holm = each.contrasts.to_dict("records") if each.contrasts is not None else [None] * len(each.tukey)
        for pair, contrast in zip(each.tukey.to_dict("records"), holm, strict=True):
            paired = ("–", "–") if contrast is None or pd.isna(contrast["p_holm"]) else (
                thesis_p(contrast["p_holm"]), signed(contrast["d_z"])
            )  # fmt: skip
            interval = f"[{signed(pair['ci_low'])}, {signed(pair['ci_high'])}]"
            cells = (signed(pair["difference"]), interval, thesis_p(pair["p"]), *paired)
            title = each.row.title if pair["a"] + pair["b"] == "M1M2" else ""
            rows.append((title, f"{labels[pair['a']]} minus {labels[pair['b']]}", *cells))
    if not rows:
        return None
    return Table(
        "table-pairs",
        "All pairs",
        (
            "Configuration",
            "Pair",
            "Difference",
            f"{confidence:.0%} CI",
            "p Tukey",
            "p Holm",
            "d_z",
        ),
        tuple(rows),
        text_columns=2,
        note="Intervals and p Tukey hold together for all pairs of a row. p Holm: paired t tests, adjusted within it. "
        "d_z: mean difference over the standard deviation of differences.",
    )


def table_of_raters(raters: pd.DataFrame) -> Table | None:
    """Agreement between people, question by question."""
    rows = tuple(
        (entry["question"], *(with_interval(entry, name) for name in ("icc_a1", "icc_ak", "alpha")))
        for entry in raters.to_dict("records")
    )
    head = ("Question", "ICC(A,1), one rater", "ICC(A,k), all raters", "Krippendorff’s α, ordinal")
    note = "95% intervals in brackets; that of α is a bootstrap over pictures."
    return Table("table-raters", "Agreement between people", head, rows, note=note) if rows else None


def with_interval(entry: Mapping[Hashable, float], name: str) -> str:
    """.290 [.019, .761]; without the bracket where there is no interval."""
    if math.isnan(entry[f"{name}_low"]):
        return f"{no_zero(entry[name], 3)} (no interval)"
    value, low, high = (no_zero(entry[key], 3) for key in (name, f"{name}_low", f"{name}_high"))
    return f"{value} [{low}, {high}]"


def table_of_retests(retests: pd.DataFrame) -> Table | None:
    """Self-agreement on pictures shown more than once."""
    if retests.empty:
        return None
    rows = [
        (
            entry["question"],
            entry["showings"],
            str(entry["n"]),
            entry["means"],
            f"{entry['within_sd']:.2f}",
            f"{entry['mean_abs_difference']:.2f}",
            f"{entry['share_equal']:.0%}",
            f"{entry['share_within_1']:.0%}",
        )
        for entry in retests.to_dict("records")
    ]
    head = ("Question", "Showings", "n", "Means", "Within-person SD", "Mean |difference|", "Same answer", "Within 1")
    return Table("table-retest", "One picture, shown more than once", head, tuple(rows), text_columns=2)
