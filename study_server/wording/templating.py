"""Templates and what they say in the page's language, which is their `language`: {% trans %}, gettext, number, day."""

from datetime import date
from pathlib import Path

from babel.dates import format_date
from babel.numbers import format_decimal
from fastapi.templating import Jinja2Templates
from jinja2 import Environment, FileSystemLoader, StrictUndefined, pass_context
from jinja2.runtime import Context

from study_server.wording.language import catalogue

environment = Environment(
    loader=FileSystemLoader(Path(__file__).parent.parent / "templates"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
environment.add_extension("jinja2.ext.i18n")  # {% trans %}
environment.policies["ext.i18n.trimmed"] = True
environment.globals.update(mode="", session=None)  # pages outside a session
templates = Jinja2Templates(env=environment)


@pass_context
def gettext(context: Context, text: str, **blanks: object) -> str:
    """`text` in the page's language, its %(blanks)s filled in if there are any."""
    found = catalogue(context["language"]).gettext(text)
    return found % blanks if blanks else found


@pass_context
def ngettext(context: Context, one: str, many: str, n: int) -> str:
    """`one` or `many` in the page's language, as it counts `n`."""
    return catalogue(context["language"]).ngettext(one, many, n)


@pass_context
def number(context: Context, n: int) -> str:
    """`n` as the page's language writes it: 1,200 in English, 1.200 in German."""
    return format_decimal(n, locale=context["language"])


@pass_context
def day(context: Context, iso: str) -> str:
    """The date `iso` (YYYY-MM-DD) in words: December 31, 2036 in English, 31. Dezember 2036 in German."""
    return format_date(date.fromisoformat(iso), "long", locale=context["language"])


environment.install_gettext_callables(gettext, ngettext)  # type: ignore[attr-defined]
environment.filters.update(number=number, day=day)
