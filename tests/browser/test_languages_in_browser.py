"""A whole session in each language, in a browser set to it: not one text of ours is left in English."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from babel.messages.pofile import read_po
from every_page import whole_session
from playwright.sync_api import Browser
from translated_study import TEXTS, translated_study

from study_server.serve import served
from study_server.wording.language import LOCALES

pytestmark = pytest.mark.browser

EVERYTHING = """() => {
  const found = new Set([document.title]);
  const texts = document.createTreeWalker(document.documentElement, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) found.add(texts.currentNode.data.replace(/<[^>]+>/g, ""));
  for (const element of document.querySelectorAll("*"))
    for (const { name, value } of element.attributes)
      if (/^(alt|title|placeholder|aria-label|data-.*)$/.test(name)) found.add(value);
  return [...found].map((text) => text.trim()).filter(Boolean);
}"""
"""All texts of a page, shown or kept for later, and what is read aloud instead of showing."""


def english(language: str) -> Iterator[re.Pattern[str]]:
    """The texts of ours that are different in `language`, with anything in their blanks."""
    with (LOCALES / f"{language}.po").open("rb") as file:
        for message in read_po(file, locale=language):
            one = message.id if isinstance(message.id, str) else message.id[0]
            if one and message.string != one:
                yield re.compile(re.sub(r"\\{\w+\\}|%\\\(\w+\\\)s", ".+", re.escape(one.strip())))


@pytest.mark.parametrize(
    ("locale", "written", "others", "language"),
    [
        ("de-AT", "en", ("de", "es", "fr"), "de"),
        ("es-MX", "fr", ("es",), "es"),
        ("en-GB", "fr", (), "fr"),
        pytest.param("en-GB", "de", ("en",), "en", marks=pytest.mark.long),
        pytest.param("fr-CA", "es", ("fr",), "fr", marks=pytest.mark.long),
        pytest.param("en-GB", "de", (), "de", marks=pytest.mark.long),
    ],
)
def test_no_page_has_two_languages(
    browser: Browser, tmp_path: Path, locale: str, written: str, others: tuple[str, ...], language: str
) -> None:
    folder = translated_study(tmp_path / "study", written, *others, screen_check=["card", "wedge", "plates"])
    foreign = [re.compile(re.escape(words)) for other in TEXTS if other != language for words in TEXTS[other].values()]
    ours = list(english(language)) if language != "en" else []
    pages = []
    with served(folder, mode="pilot") as url, browser.new_context(locale=locale) as context:
        page = context.new_page()

        def look(name: str) -> None:
            pages.append(name)
            assert page.locator("html").get_attribute("lang") == language
            shown = page.evaluate(EVERYTHING)
            own = set(TEXTS[language].values())
            left = [
                text for text in shown if text not in own and any(words.fullmatch(text) for words in ours + foreign)
            ]
            assert left == [], f"{name}: {left}"

        whole_session(page, url, look)
    assert pages[-3:] == ["done", "withdraw", "withdrawn"]
