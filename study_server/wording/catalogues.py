"""Remakes locales/*.po from what participants read: `python -m study_server.wording.catalogues` (`make catalogues`).

Texts are marked by {% trans %} in templates and by `N_` and `.plural` in Python; admin pages are in English and not
marked. What is new gets an empty translation, for somebody who speaks the language to fill in; what is gone is dropped.
Babel's own command line does the same in four calls, but writes line numbers and dates: every edit would be a change.
"""

from io import BytesIO
from pathlib import Path

from babel.messages import Catalog
from babel.messages.extract import extract_from_dir
from babel.messages.pofile import read_po, write_po

from study_server.wording.language import LOCALES

HERE = Path(__file__).parent.parent
METHODS = [("**.py", "python"), ("templates/*.html", "jinja2")]
OPTIONS = {"templates/*.html": {"trimmed": "true", "silent": "false"}}
KEYWORDS = {"N_": None, "plural": (1, 2), "gettext": None, "_": None, "ngettext": (1, 2)}
LANGUAGES = ("de", "es", "fr")


def extracted() -> Catalog:
    """Every text that is marked, without translation."""
    catalog = Catalog(fuzzy=False)
    for name, _, message, _, _ in extract_from_dir(HERE, METHODS, OPTIONS, KEYWORDS):
        catalog.add(message, None, [(f"study_server/{name}", 0)])
    return catalog


def remade(language: str) -> bytes:
    """locales/<language>.po as it should be: its translations of today's texts, each with the files that hold it."""
    with (LOCALES / f"{language}.po").open("rb") as file:
        catalog = read_po(file, locale=language)
    catalog.update(extracted(), no_fuzzy_matching=True)
    catalog.obsolete.clear()
    written = BytesIO()
    write_po(written, catalog, width=0, omit_header=True, sort_by_file=True, include_lineno=False)
    return HEADER.format(language=language, plurals=catalog.plural_forms).encode() + written.getvalue()


HEADER = r"""msgid ""
msgstr ""
"Language: {language}\n"
"MIME-Version: 1.0\n"
"Content-Type: text/plain; charset=utf-8\n"
"Content-Transfer-Encoding: 8bit\n"
"Plural-Forms: {plurals}\n"

"""


if __name__ == "__main__":
    for language in LANGUAGES:
        (LOCALES / f"{language}.po").write_bytes(remade(language))
