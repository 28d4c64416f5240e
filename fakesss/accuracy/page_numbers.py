"""Numbers and values as the pages write them."""

from collections.abc import Mapping
from typing import Any

SUPERSCRIPT = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
PLAIN = (1e-3, 1e5)
"""Numbers between these are written out, others with a power of ten."""


def rounded(number: float, digits: int = 3) -> str:
    """`number` to so many significant digits: 0.0123, 12.3, 1,230, 1.23 × 10⁻⁵."""
    if number == 0:
        return "0"
    size = f"{abs(number):.{digits - 1}e}"
    mantissa, exponent = size.split("e")
    sign = "−" if number < 0 else ""
    if PLAIN[0] <= float(size) < PLAIN[1]:
        decimals = max(0, digits - 1 - int(exponent))
        text = f"{float(size):,.{decimals}f}"
        return sign + (text.rstrip("0").rstrip(".") if "." in text else text)
    factor = mantissa.rstrip("0").rstrip(".")
    power = "10" + str(int(exponent)).translate(SUPERSCRIPT)
    return sign + (power if factor == "1" else f"{factor} × {power}")


def duration(seconds: float) -> str:
    """A time as a person says it: 3.2 µs, 12.3 ms, 4.5 s, 40 min, 2.5 h."""
    for limit, unit, size in ((1e-3, "µs", 1e-6), (1, "ms", 1e-3), (120, "s", 1), (7200, "min", 60)):
        if seconds < limit:
            return f"{rounded(seconds / size)} {unit}"
    return f"{rounded(seconds / 3600)} h"


def value_text(value: Any) -> str:
    """A knob's value as a reader meets it: `true` and `false` are on and off, long numbers are cut."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if value is None:
        return "none"
    if isinstance(value, float):
        return rounded(value, 4)
    if isinstance(value, Mapping):
        return ", ".join(f"{name} = {value_text(each)}" for name, each in value.items())
    return str(value)


def power_of_two(gain: int) -> str:
    """2 to the `gain`, as a factor in words: ×1, ×32 (2⁵)."""
    return "×1" if gain == 0 else f"×{2**gain:,} (2{str(gain).translate(SUPERSCRIPT)})"
