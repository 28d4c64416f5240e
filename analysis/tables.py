"""Tables for the page: every cell as it will be read."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from analysis.families import family_words
from analysis.plan import AnalysisPlan
from analysis.results import METHODS, Analysed
from analysis.wording import (
    apa_df,
    exact_p,
    joined,
    no_zero,
    percent,
    share_interval,
    thesis_hsd,
    thesis_p,
    thesis_verdict,
)

SHORT = {"holm": "Holm", "fdr": "BH"}
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


def told_once(table: Table, *names: str) -> Table:
    """`table` with those of the named columns that are the same in all rows said in its note instead."""
    same = [name for name in names if len({row[table.head.index(name)] for row in table.rows}) == 1]
    places = [table.head.index(name) for name in same]
    values = joined([f"{name} = {table.rows[0][place]}" for name, place in zip(same, places, strict=True)])
    kept = [place for place in range(len(table.head)) if place not in places]
    everywhere = f"In every row {values}." if same else ""
    return replace(
        table,
        head=tuple(table.head[place] for place in kept),
        rows=tuple(tuple(row[place] for place in kept) for row in table.rows),
        note=" ".join(filter(None, (everywhere, table.note))),
    )


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
        f"Table 4.4. Results of the one-way ANOVA, {METHODS[mode]} (significance level {percent(plan.alpha)})",
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
    samples = "; ".join(f"{level.code} {level.printed} ({means[level.code]:.2f})" for level in each.row.levels)
    first = each.tukey.iloc[0]
    note = f"Means: {samples}. n = {sizes_text(each.n)}, df = {first['df']}, MSE = {first['mse']:.3f}."
    if hsd:
        note += f" Unrounded HSD {hsd[0]:.4f} and {hsd[1]:.4f} decide."
    return Table(
        f"table-4-5-{each.mode}-{each.row.question}",
        f"Table 4.5. Tukey HSD test of {each.row.compared} on “{each.row.question}”, {METHODS[each.mode]} ({heading})",
        ("Samples", "P", "|difference|", "q", "p (Tukey)"),
        tuple(rows),
        text_columns=2,
        note=note,
    )


def table_of_tests(found: Sequence[Analysed], plan: AnalysisPlan) -> Table:
    """The test that fits the design: corrected for sphericity, adjusted over the declared family, with effect size."""
    tested = [each for each in found if each.p is not None]
    note = f"p Holm and p BH (Benjamini–Hochberg): adjusted over {family_words(plan, found)}. {decides(plan)}"
    head: tuple[str, ...] = ("Configuration", "F", "df", "n", "p", "p Holm", "p BH", "η² [90% CI]")
    caption = "One-way ANOVA of independent samples"
    if found and found[0].mode == "repeated":
        head = ("Configuration", "F", "df", "n", "p", "p Holm", "p BH", "η²G [90% CI]", "ε GG, HF")
        note = (
            "df and p are Greenhouse–Geisser corrected; the ε of Huynh–Feldt for comparison. η²G: generalized eta "
            f"squared. {note}"
        )
        crossed = any(each.row.crossed for each in found)
        caption = "Factorial repeated-measures ANOVA" if crossed else "Repeated-measures ANOVA"
    rows = tuple(map(test_cells, tested))
    return told_once(Table("table-tests", f"{caption}, corrected, with effect sizes", head, rows, note=note), "n")


def decides(plan: AnalysisPlan) -> str:
    """Which of the columns the words of the report follow."""
    return f"{'p' if plan.adjust == 'none' else f'p {SHORT[plan.adjust]}'} decides (adjust in [analysis])."


def test_cells(each: Analysed) -> tuple[str, ...]:
    """One line of `table_of_tests`."""
    assert each.anova is not None and each.p is not None
    adjusted = ("–" if p is None else thesis_p(p) for p in (each.p_holm, each.p_fdr))
    _, size, low, high = each.effect
    df1, df2 = map(apa_df, each.df)
    repeated = each.mode == "repeated"
    shrink = [no_zero(each.anova[name], 3) for name in ("epsilon_gg", "epsilon_hf")] if repeated else []
    epsilons = (", ".join(shrink),) if repeated else ()
    tail = (thesis_p(each.p), *adjusted, f"{no_zero(size, 3)} {share_interval(low, high)}")
    return (each.row.title, f"{each.anova['F']:.2f}", f"{df1}, {df2}", sizes_text(each.n), *tail, *epsilons)


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
    return " minus ".join(level.printed for level in each.row.levels if level.code in rated)


def table_of_friedman(found: Sequence[Analysed]) -> Table | None:
    """Rows of three and more samples; None where there are none."""
    rows = tuple(
        (
            each.row.title,
            f"{each.friedman['chi2']:.2f}",
            f"{each.friedman['df']:.0f}",
            f"{each.friedman['n']:.0f}",
            thesis_p(each.friedman["p"]),
            no_zero(each.friedman["kendalls_w"], 3),
        )
        for each in found
        if each.friedman is not None
    )
    head = ("Configuration", "χ²", "df", "n", "p", "Kendall W")
    table = Table("table-ranks", "Friedman's test: ranks instead of means", head, rows)
    return told_once(table, "n") if rows else None
