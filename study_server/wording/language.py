"""Which language a page is in, and its words: ours from locales/, a study's own from its [survey.translations]."""

import gettext
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from io import BytesIO
from pathlib import Path

from babel.core import negotiate_locale
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po

from study_server.settings import Survey, SurveySettings

LOCALES = Path(__file__).parent.parent / "locales"


@dataclass(frozen=True)
class Words:
    """Texts of one language; a text without a translation stays as it is written."""

    language: str
    own: Mapping[str, str]

    def __call__(self, text: str) -> str:
        """`text` in this language, the study's own translation before ours."""
        return self.own.get(text) or (catalogue(self.language).gettext(text) if text else "")

    def plural(self, one: str, many: str, n: int) -> str:
        """`one` or `many`, as this language counts `n`."""
        return catalogue(self.language).ngettext(one, many, n)


def words(settings: SurveySettings, language: str) -> Words:
    """The words of a page of this study."""
    return Words(language, settings.own_words(language))


@cache
def catalogue(language: str) -> gettext.NullTranslations:
    """locales/<language>.po, ready to be asked; English is what the texts are written in."""
    path = LOCALES / f"{language}.po"
    if not path.exists():
        return gettext.NullTranslations()
    compiled = BytesIO()
    with path.open("rb") as file:
        write_mo(compiled, read_po(file, locale=language))
    compiled.seek(0)
    return gettext.GNUTranslations(compiled)


def offered(survey: Survey) -> tuple[str, ...]:
    """The languages this study's own texts are there in, the one they are written in first."""
    return (survey.language, *(language for language in survey.translations if language != survey.language))


def negotiated(survey: Survey, accepted: str, wanted: str = "") -> str:
    """The best of the study's languages for a browser's Accept-Language header; `wanted` was chosen by hand."""
    if wanted in offered(survey):
        return wanted
    return negotiate_locale(by_preference(accepted), offered(survey), sep="-") or survey.language


def by_preference(accepted: str) -> list[str]:
    """Languages of an Accept-Language header (RFC 9110, 12.5.4), most wanted first."""
    weighted = []
    for part in accepted.split(","):
        tag, _, parameter = part.strip().partition(";")
        try:
            weight = float(parameter.strip().removeprefix("q=") or 1)
        except ValueError:
            continue
        if tag and weight > 0:
            weighted.append((-weight, tag.split("-")[0].lower()))
    return [tag for _, tag in sorted(weighted, key=lambda pair: pair[0])]
