"""Our own consent text says what this study stores of this visitor, and nothing that it does not store."""

from pathlib import Path

import pytest
from study_fixture import write_study

from study_server.guards.tokens import External
from study_server.manifest import load_study
from study_server.pages import consent_page
from study_server.wording import texts

SCREEN = "Before the pictures come checks of your screen"
CARD, WEDGE, PLATES = "with a bank card", "dark and bright patches", "your colour vision"
NAMES = "the service which sent you here"
NO_DATE = "No date is set"
EVERY = {SCREEN, CARD, WEDGE, PLATES, NAMES, NO_DATE}


@pytest.mark.parametrize(
    ("survey", "external", "said"),
    [
        ({}, None, {SCREEN, CARD, WEDGE, NO_DATE}),
        ({}, External("s1", "p1"), {SCREEN, CARD, WEDGE, NAMES, NO_DATE}),
        ({"screen_check": ["plates"]}, None, {SCREEN, PLATES, NO_DATE}),
        ({"screen_check": [], "retention": "ten years"}, None, set()),
        ({"screen_check": ["wedge"], "retention_until": "2036-12-31"}, None, {SCREEN, WEDGE}),
        ({"consent": "Our own words."}, External("s1", "p1"), set()),
    ],
)
def test_it_follows_from_the_settings(
    tmp_path: Path, survey: dict[str, object], external: External | None, said: set[str]
) -> None:
    study = load_study(write_study(tmp_path, survey=survey))
    page = consent_page(study, "live", "token", "en", external)
    text = " ".join(page["paragraphs"])
    assert {words for words in EVERY if words in text} == said
    assert (texts.STORED[()] in text) is ("consent" not in survey)
