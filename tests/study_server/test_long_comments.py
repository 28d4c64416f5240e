"""The longest comment that the page takes arrives whole, in every script, and the code is shown after it."""

import html
import re
from collections.abc import Callable
from urllib.parse import urlencode

import httpx
import pytest
from survey_client import Participant

from study_server.guards.web_safety import BODY_LIMIT
from study_server.steps import LONGEST_TEXT

LONGEST = {
    "latin": "x" * LONGEST_TEXT,
    "accents": "é" * LONGEST_TEXT,
    "chinese": "漢" * LONGEST_TEXT,
    "emoji": "😀" * (LONGEST_TEXT // 2),  # a textarea's maxlength counts UTF-16's units, and here two are one
    "lines": "x\n" * (LONGEST_TEXT // 2 - 1) + "xx",
    "formula": "=" * LONGEST_TEXT,
}


@pytest.fixture
def at_comments(url: str) -> Participant:
    """Somebody who gave every rating and is asked for a comment."""
    person = Participant(url).to_trials()
    while person.state["step"] == "trials":
        person.rate()
    assert person.state["step"] == "comments"
    return person


def test_the_page_takes_as_much_as_is_kept(at_comments: Participant) -> None:
    page = at_comments.client.get(at_comments.here, headers={"Accept": "text/html"}).text
    assert re.search(r'<textarea[^>]*name="comments"[^>]*maxlength="(\d+)"', html.unescape(page))[1] == str(
        LONGEST_TEXT
    )  # type: ignore[index]


@pytest.mark.parametrize("kind", LONGEST)
def test_the_longest_comment_is_kept_and_the_code_shown(
    at_comments: Participant, exported: Callable[..., list[dict[str, str]]], kind: str
) -> None:
    comment = LONGEST[kind]
    assert len(comment.encode("utf-16-le")) == 2 * LONGEST_TEXT
    body = urlencode({"comments": comment.replace("\n", "\r\n")})  # as a browser's form sends it
    assert len(body) < BODY_LIMIT
    headers = {"Content-Type": "application/x-www-form-urlencoded"}
    response: httpx.Response = at_comments.client.post(f"{at_comments.here}/comments", content=body, headers=headers)
    assert response.status_code == 200, response.text[:200]
    assert response.json()["completion_code"]
    assert exported("participants")[0]["comments"].removeprefix("'") == comment


def test_who_sends_more_can_still_send_less(at_comments: Participant) -> None:
    response = at_comments.client.post(f"{at_comments.here}/comments", data={"comments": "x" * BODY_LIMIT})
    assert response.status_code == 413
    assert at_comments.post("comments", comments="x" * (LONGEST_TEXT + 1))["completion_code"]
