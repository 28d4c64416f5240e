"""What participants read, in their language and in no other; the catalogues whole and as the program is today."""

import re
import string
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import httpx
import pytest
from babel.messages import Message
from babel.messages.pofile import read_po
from sqlalchemy import text
from study_fixture import write_study
from survey_client import JSON, Participant
from translated_study import TEXTS, tables, translated_study

from fakesss.problem import BadInput
from study_server.participant import STRANGER
from study_server.serve import served
from study_server.settings import check_survey
from study_server.site import HERE
from study_server.storage.database import default_url, open_database
from study_server.wording.catalogues import LANGUAGES, remade
from study_server.wording.language import LOCALES, by_preference, catalogue

HTML = {"Accept": "text/html"}
FOR_RESEARCHERS = {"admin.html", "close.html", "login.html", "tables.html"}
"""These are in English."""


def messages(language: str) -> Iterator[tuple[Message, list[str], list[str]]]:
    """Each message of a catalogue, its texts and its translations."""
    with (LOCALES / f"{language}.po").open("rb") as file:
        for message in read_po(file, locale=language):
            if message.id:
                several = not isinstance(message.id, str)
                yield (
                    message,
                    list(message.id if several else [message.id]),
                    list(message.string if several else [message.string]),
                )


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_catalogue_is_as_make_catalogues_would_write_it(language: str) -> None:
    assert (LOCALES / f"{language}.po").read_bytes() == remade(language), "run `make catalogues`"


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_text_is_translated_with_the_same_blanks(language: str) -> None:
    for message, source, translated in messages(language):
        assert all(translated), f"{language}: not translated: {source[0]}"
        assert not message.fuzzy, f"{language}: unsure: {source[0]}"
        for said, each in zip(source, translated, strict=True):  # all of these have two forms of number
            assert blanks(each) == blanks(said), f"{language}: other blanks: {each}"
            assert re.findall(r"<[^>]+>", each) == re.findall(r"<[^>]+>", said), f"{language}: other markup: {each}"


def blanks(words: str) -> set[str]:
    """{names} and %(names)s to be filled in."""
    return {name for _, name, _, _ in string.Formatter().parse(words) if name} | set(re.findall(r"%\(\w+\)s", words))


def test_the_typography_of_each_language() -> None:
    for language, wrong in {
        "de": r"[\"'“](?=\w)|\bdu\b|\bdein",  # „so“, and people are addressed formally
        "es": r"[\"']|\btú\b|\btus?\b|^[^¿]*\?|^[^¡]*!",  # questions begin with ¿
        "fr": r"[\"']|(?<!\u202f)[?!;:»](?!\w)|«(?!\u202f)|\btu\b|\btes\b",  # narrow no-break spaces
    }.items():
        for _, _, translated in messages(language):
            for each in translated:
                assert not re.search(wrong, re.sub(r"<[^>]+>|\{\w*\}", "", each)), f"{language}: {each}"


class Visible(HTMLParser):
    """Collects what a reader sees or hears of a template: text, and attributes that are read out."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_data(self, data: str) -> None:
        self.found.append(data)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += [value or "" for name, value in attrs if name in ("alt", "aria-label", "placeholder", "title")]


@pytest.mark.parametrize("name", sorted({path.name for path in (HERE / "templates").iterdir()} - FOR_RESEARCHERS))
def test_no_template_holds_words_that_are_not_marked(name: str) -> None:
    template = (HERE / "templates" / name).read_text(encoding="utf-8")
    template = re.sub(r"\{% trans.*?\{% endtrans %\}|\{#.*?#\}|\{%.*?%\}|\{\{.*?\}\}", "", template, flags=re.DOTALL)
    visible = Visible()
    visible.feed(template)
    assert [words.strip() for words in visible.found if re.search("[A-Za-z]", words)] == []


@pytest.mark.parametrize(
    "name", sorted(path.name for path in (HERE / "static").glob("*.js") if "admin" not in path.name)
)
def test_no_participants_script_holds_words(name: str) -> None:
    code = (HERE / "static" / name).read_text(encoding="utf-8")
    code = re.sub(r"//.*|new Damaged\(.*?\);", "", code)
    assert re.findall(r"""["'`][A-Z][^"'`]* [^"'`]*["'`]""", code) == []


@pytest.mark.parametrize(
    ("accepted", "preferred"),
    [
        ("de-AT,de;q=0.9,en;q=0.8", ["de", "de", "en"]),
        ("en;q=0.3, fr", ["fr", "en"]),
        ("es;q=0, fr;q=0.1", ["fr"]),
        ("*", ["*"]),
        ("de;q=x, es", ["es"]),
        ("", []),
    ],
)
def test_accept_language(accepted: str, preferred: list[str]) -> None:
    assert by_preference(accepted) == preferred


@pytest.fixture
def in_four(tmp_path: Path) -> Iterator[str]:
    """A study written in English and translated into all the others, served."""
    with served(translated_study(tmp_path / "study", "en", *LANGUAGES)) as url:
        yield url


@pytest.mark.parametrize(
    ("accepted", "query", "language"),
    [
        ("de-CH,fr;q=0.5", "", "de"),
        ("pt,fr;q=0.5", "", "fr"),
        ("pt", "", "en"),
        ("", "", "en"),
        ("de", "?language=es", "es"),
        ("de", "?language=pt", "de"),
        ("de", "?language=fr&STUDY_ID=s&PROLIFIC_PID=p", "fr"),
    ],
)
def test_the_browser_or_the_visitor_chooses_and_the_session_keeps_it(
    in_four: str, accepted: str, query: str, language: str
) -> None:
    client = httpx.Client(base_url=in_four, headers={**HTML, "Accept-Language": accepted}, follow_redirects=True)
    with client:
        consent = client.get(f"/{query}")
        assert consent.headers["Content-Language"] == language
        assert "Accept-Language" in consent.headers["Vary"]
        assert f'<html lang="{language}">' in consent.text
        heading = catalogue(language).gettext("Before you begin")
        assert f"<title>{heading} – {TEXTS[language]['title']}</title>" in consent.text
        here = consent.url.path
        fields = dict(re.findall(r'<input type="hidden" name="(\w+)" value="(\w*)">', consent.text))
        declined = client.post(f"{here}/declined", data=fields)
        assert f'<html lang="{language}">' in declined.text
        client.post(f"{here}/consent", data=fields)
        client.headers["Accept-Language"] = "en"
        kept = client.get(f"{here}?language=en")
        assert kept.headers["Content-Language"] == language
        assert TEXTS[language]["hand"] in kept.text


def test_the_switch_keeps_who_came_from_prolific(in_four: str) -> None:
    person = Participant(in_four, "?STUDY_ID=s&PROLIFIC_PID=p%26q&SESSION_ID=x&language=de")
    spanish = next(link for link in person.state["languages"] if link["code"] == "es")
    assert spanish["name"] == "Español"
    again = person.client.get(person.here + spanish["href"])
    assert again.json()["external"] == {"STUDY_ID": "s", "PROLIFIC_PID": "p&q", "SESSION_ID": "x"}
    assert (again.json()["language"], again.json()["here"]) == ("es", person.here)
    visitor = Participant(in_four)
    page = visitor.client.get(visitor.here + "?language=es", headers=HTML).text
    assert '<a href="?language=fr" hreflang="fr" lang="fr">Français</a>' in page
    assert 'hreflang="es" lang="es" aria-current="true">Español</a>' in page


def test_a_study_in_one_language_is_in_that_language_for_everybody(tmp_path: Path) -> None:
    with served(write_study(tmp_path / "english")) as url:
        person = Participant(url)
        person.client.headers["Accept-Language"] = "de"
        page = person.client.get(person.here, headers=HTML)
        assert 'lang="en"' in page.text and "Before you begin" in page.text
        assert "hreflang" not in page.text
        assert person.client.get("/nowhere").json()["error"] == "There is no such page."
    with served(translated_study(tmp_path / "german", "de")) as url:
        person = Participant(url)
        page = person.client.get(person.here, headers={**HTML, "Accept-Language": "en"})
        assert 'lang="de"' in page.text and "Bevor Sie beginnen" in page.text
        assert "zehn Jahre, bis zum 31. Dezember 2036" in page.text


@pytest.mark.parametrize("language", ["en", *LANGUAGES])
def test_dates_are_written_as_in_that_language(in_four: str, language: str) -> None:
    person = Participant(in_four, f"?language={language}")
    assert person.state["retention_until"] == "2036-12-31"
    page = person.client.get(f"{person.here}?language={language}", headers=HTML).text
    written = {
        "en": "ten years, until December 31, 2036",
        "de": "zehn Jahre, bis zum 31. Dezember 2036",
        "es": "diez años, hasta el 31 de diciembre de 2036",
        "fr": "dix ans, jusqu’au 31 décembre 2036",
    }
    assert written[language] in page


def test_what_is_stored_is_the_text_as_the_study_has_it(in_four: str) -> None:
    person = Participant(in_four, "?language=de")
    person.post("consent", language="de")
    hand = person.state["fields"][0]
    assert hand["labels"] == [TEXTS["de"]["left"], TEXTS["de"]["right"]]
    assert hand["choices"] == [TEXTS["en"]["left"], TEXTS["en"]["right"]]
    other = person.client.post(f"{person.here}/about", json={"hand": TEXTS["de"]["left"]})  # no choice of this study
    assert other.status_code == 422
    assert other.json()["fields"][0]["problem"] == catalogue("de").gettext("Please choose one of these answers.")
    assert person.post("about", hand=TEXTS["en"]["left"])["step"] == "screen"


def test_errors_are_in_the_language_of_the_session_or_of_the_browser(tmp_path: Path) -> None:
    folder = translated_study(tmp_path / "study", "en", *LANGUAGES, screen_check=[], practice=0)
    with served(folder) as url:
        french = {**JSON, "Accept-Language": "fr"}
        assert httpx.get(f"{url}/s/nobody", headers=french).json()["error"] == catalogue("fr").gettext(STRANGER)
        page = httpx.get(f"{url}/nowhere", headers={**HTML, "Accept-Language": "es"})
        assert '<html lang="es">' in page.text and "Esta página no existe." in page.text
        assert "There is no such page." in httpx.get(f"{url}/admin/nowhere", headers=french).json()["error"]
        wrong = httpx.delete(f"{url}/s/nobody", headers={**HTML, "Accept-Language": "es"})  # for programmers
        assert '<html lang="en">' in wrong.text and "Sorry" in wrong.text
        person = Participant(url)
        person.post("consent", language="de")
        person.post("about", hand=TEXTS["en"]["left"])
        person.post("instructions")
        refused = person.send(person.answers(9))
        assert (refused.status_code, refused.json()["error"]) == (422, "Eine Antwort muss zwischen 1 und 7 liegen.")
        with open_database(default_url(folder)).writing() as connection:
            connection.execute(text("DROP TABLE ratings"))
        failed = person.send(person.answers())
        assert (failed.status_code, failed.headers["Content-Language"]) == (503, "de")
        assert failed.json()["error"].startswith("Das konnte gerade nicht gespeichert werden")


def test_the_address_of_a_form_leads_back_to_the_page(in_four: str) -> None:
    person = Participant(in_four).consent()
    assert person.client.get(f"{person.here}/about").json()["step"] == "about"


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"title": None}, "survey.translations.de: title is missing; add a line title = "),
        ({"consent": None}, "survey.translations.de: consent is missing; add a line consent = "),
        ({"the left one": None}, 'about.hand is missing; add a line "the left one" = '),
        ({"The object looks translucent.": None}, "survey.translations.de: question.translucent is missing"),
        ({"the left on": "x"}, '"the left on" is no text of this file; did you mean "the left one"?'),
        ({"instructions": "x"}, '"instructions" is no text of this file; write the text as it stands'),
        ({"completely agree": "trifft zu"}, ""),  # our own words may be replaced
    ],
)
def test_a_translation_holds_every_text_and_no_other(change: dict[str, Any], sentence: str) -> None:
    study = tables("en", "de")
    known = {**study["survey"]["translations"]["de"], **change}
    study["survey"]["translations"]["de"] = {key: words for key, words in known.items() if words is not None}
    if not sentence:
        assert check_survey(study, "study.toml").own_words("de")["completely agree"] == "trifft zu"
        return
    with pytest.raises(BadInput) as problem:
        check_survey(study, "study.toml")
    assert sentence in str(problem.value)
    assert "\n" not in str(problem.value)


def test_the_studys_own_title_is_translated_too() -> None:
    study: dict[str, Any] = {"title": "Discs", "question": [{"name": "q", "text": "7"}]}
    study["survey"] = {"translations": {"de": {}}}
    with pytest.raises(BadInput, match=r"translations\.de: title is missing"):
        check_survey(study, "study.toml")
    study["survey"]["translations"]["de"] = {"title": "Scheiben"}
    assert check_survey(study, "study.toml").own_words("de") == {"Discs": "Scheiben"}
