"""Names of sessions and people in the export are text to every program: no spreadsheet rounds them."""

import hashlib
import hmac
import re
from collections.abc import Callable

from survey_client import Participant

from study_server.guards.tokens import pseudonym

SALT = "salt"


def plain(text: str) -> str:
    """A pseudonym as it was before some looked like numbers."""
    return hmac.new(SALT.encode(), text.encode(), hashlib.sha256).hexdigest()[:16]


def test_a_pseudonym_is_no_number_and_else_what_it_was() -> None:
    names = {text: pseudonym(SALT, text) for text in map(str, range(20_000))}
    numbers = [text for text in names if re.fullmatch(r"\d+(e\d+)?", plain(text))]
    assert len(numbers) > 10, "1 in 800"
    assert {names[text] for text in numbers} == {f"p{plain(text)}" for text in numbers}
    assert all(name == plain(text) for text, name in names.items() if text not in numbers)
    assert len(set(names.values())) == len(names)


def test_a_session_begins_with_a_letter(url: str, exported: Callable[..., list[dict[str, str]]]) -> None:
    Participant(url).consent()
    assert re.fullmatch("s[0-9a-f]{16}", exported("participants")[0]["session"])
