"""Do the tests of a row agree? Analysis of variance, ranks, ordinal regression and mixed model, side by side."""

from collections.abc import Iterator, Sequence

from analysis.models import Modelled
from analysis.results import Analysed
from analysis.wording import joined, percent

NAMES = {"anova": "ANOVA", "ranks": "ranks", "ordinal": "ordinal regression", "mixed": "mixed model"}


def tested_rows(models: Sequence[Modelled]) -> Iterator[tuple[Analysed, dict[str, float]]]:
    """Every row with the p of each of its tests."""
    for model in models:
        for each in model.found:
            tests = {"ordinal": model.test(model.ordinal, each), "mixed": model.test(model.mixed, each)}
            p = {"anova": each.p, "ranks": each.rank_p}
            p |= {name: float(test["p"]) for name, test in tests.items() if test is not None}
            yield each, {name: value for name, value in p.items() if value is not None}


def finders(p: dict[str, float], alpha: float) -> str:
    """Who finds an effect at `alpha`, for a table: all, none, all but one, or by name."""
    yes = [NAMES[name] for name, value in p.items() if value < alpha]
    no = [NAMES[name] for name, value in p.items() if not value < alpha]
    if not yes or not no:
        return "" if not p else "all" if yes else "none"
    return f"all but {no[0]}" if len(no) == 1 < len(yes) else joined(yes)


def verdict(p: dict[str, float], alpha: float) -> str:
    """Who stands apart from whom, for a sentence about tests that disagree."""
    yes = [NAMES[name] for name, value in p.items() if value < alpha]
    no = [NAMES[name] for name, value in p.items() if not value < alpha]
    if len(no) == 1 < len(yes):
        return f"only {no[0]} {finds(no)} none"
    if len(yes) == 1 < len(no):
        return f"only {yes[0]} {finds(yes)} an effect"
    return f"{joined(yes)} {finds(yes)} an effect, {joined(no)} {finds(no)} none"


def finds(names: list[str]) -> str:
    """The verb: ranks are many."""
    return "finds" if len(names) == 1 and names != [NAMES["ranks"]] else "find"


def agreement_of_tests(models: Sequence[Modelled], alpha: float, *, adjusted: bool = False) -> str:
    """One sentence: in how many rows all tests say the same, and who stands apart where they do not. `adjusted`: other
    words of the report follow an adjusted p, so that these do not is said."""
    compared = [(each, p) for each, p in tested_rows(models) if len(p) > 1]
    if not compared:
        return ""
    names = joined([name for key, name in NAMES.items() if any(key in p for _, p in compared)])
    apart = [
        f"{each.row.title} ({verdict(p, alpha)})"
        for each, p in compared
        if len({value < alpha for value in p.values()}) > 1
    ]
    head = f"At the {percent(alpha)} level{', each p unadjusted,' if adjusted else ''} {names}"
    if not apart:
        rows = {1: "the only row", 2: "both rows"}.get(len(compared), f"all {len(compared)} rows")
        return f"{head} agree in {rows}{lacking(compared)}."
    if len(apart) == len(compared):
        rows = "the only row" if len(apart) == 1 else "every row"
        return f"{head} disagree in {rows}{lacking(compared)}: {joined(apart)}."
    agree = len(compared) - len(apart)
    return f"{head} agree in {agree} of {len(compared)} rows{lacking(compared)}; not in {joined(apart)}."


def lacking(compared: Sequence[tuple[Analysed, dict[str, float]]]) -> str:
    """How many rows lack a test that others have."""
    most = max(len(p) for _, p in compared)
    fewer = sum(len(p) < most for _, p in compared)
    return f" ({fewer} of them without every test)" if fewer else ""
