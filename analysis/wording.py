"""Numbers as the thesis prints them, and as the APA's manual does."""

import math
import re
from typing import Any


def thesis_p(p: float) -> str:
    """Table 4.4's form: "< .0001", four places below .01, else three."""
    if p < 0.0001:
        return "< .0001"
    return f"{p:.4f}" if p < 0.01 else f"{p:.3f}"


def exact_p(p: float) -> str:
    """Six significant digits; below 1e-10 only the bound, as no rating study supports such digits."""
    return "< 1e-10" if p <= 1e-10 else f"{p:.6g}" if p < 1e-3 else f"{p:.6f}"


def thesis_hsd(value: float) -> str:
    """Table 4.5's form: two places, trailing zeros dropped (1.0025 -> "1")."""
    return f"{value:.2f}".rstrip("0").rstrip(".")


def thesis_verdict(difference: float, critical_05: float, critical_01: float) -> str:
    """Table 4.5's wording, from unrounded values: a difference of 1.0000 is below an HSD of 1.0025 printed "1"."""
    if abs(difference) >= critical_01:
        return "P < .01"
    return "P < .05" if abs(difference) >= critical_05 else "Non significant"


def no_zero(value: float, places: int) -> str:
    """APA: no zero before the point of a number that cannot exceed 1."""
    text = signed(value, places)
    return text.replace("0.", ".", 1) if abs(float(f"{value:.{places}f}")) < 1 else text


def apa_p(p: float) -> str:
    """p = .012, p < .001, p > .999."""
    if p > 0.999:
        return "p > .999"
    return "p < .001" if p < 0.001 else f"p = {no_zero(p, 3)}"


def apa_df(df: float) -> str:
    """Whole degrees of freedom as they are, corrected ones to two places."""
    return f"{df:g}" if math.isclose(df, round(df), abs_tol=1e-9) else f"{df:.2f}"


def joined(words: list[str]) -> str:
    """a, b and c."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}" if words else ""


def signed(value: float, places: int = 2) -> str:
    """With a true minus sign; never "-0.00"."""
    text = f"{value:.{places}f}"
    return text.lstrip("-") if float(text) == 0 else text.replace("-", "−")


def percent(share: float) -> str:
    """A share that was declared (a level, a bound), with every digit of it: 5%, 99.5%, 0.5%."""
    return f"{100 * share:.10g}%"


def steps(margin: float) -> str:
    """±1 step, ±0.5 steps."""
    return f"±{margin:g} step{'' if margin == 1 else 's'}"


def true_minus(text: str) -> str:
    """A label as it is printed: a true minus before numbers ("−35"), other hyphens ("img-35") as they are."""
    return re.sub(r"(?<![\w.])-(?=\.?\d)", "−", text)


def interval(low: float, high: float) -> str:
    """[−0.41, 0.32]."""
    return f"[{signed(low)}, {signed(high)}]"


def share_interval(low: float, high: float) -> str:
    """[.132, .326]: of what cannot exceed 1."""
    return f"[{no_zero(low, 3)}, {no_zero(high, 3)}]"


def sentence_case(text: str) -> str:
    """The first letter capital, the others as they are."""
    return text[:1].upper() + text[1:]


def counted(n: int, noun: str) -> str:
    """1 participant, 2 participants."""
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"


def level_text(value: Any) -> str:
    """25, 1.2, true, (1, 0, 0): as the study writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return "(" + ", ".join(level_text(part) for part in value) + ")"
    return f"{value:.12g}" if isinstance(value, float) else str(value)
