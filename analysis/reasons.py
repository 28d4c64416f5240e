"""Why a statistic has no value, in a reader's words: samples by their names, no column of ours."""

import re
from collections.abc import Mapping

COLUMNS = re.compile(r"^(?:variance of )?rating'*(?: by [^:]*)?: ")

PICTURE = re.compile(r'\bstimulus(?=[^"]*(?:"[^"]*"[^"]*)*$)')  # outside quotation marks, where labels stand


def reader_words(reason: object, labels: Mapping[str, str] | None = None) -> str:
    """The sentence of an `Undefined` without the columns that begin it ("rating by condition: "), and with the samples'
    names in place of their codes. `labels`: code -> name."""
    sentence = PICTURE.sub("picture", COLUMNS.sub("", str(reason)))
    for code, label in (labels or {}).items():
        sentence = sentence.replace(f'"{code}"', f"“{label}”")
    return sentence
