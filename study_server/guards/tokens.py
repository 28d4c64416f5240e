"""The participant's secret address: 128 random bits and 128 bits of proof that this server made them.

A token is valid before anything is stored under it, so that opening the link (or a mail program's preview of it)
starts nothing; and the same external person always gets the same one, so that first hits may race. The proof also says
whether the token is of somebody without a name elsewhere: an external person cannot take part without theirs.
"""

import base64
import hashlib
import hmac
import re
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

BYTES = 16
ANONYMOUS = b"anonymous\0"
NUMBER = re.compile(r"[0-9]+(e[0-9]+)?")

LONGEST = 200
"""Characters of an external name that are kept."""


@dataclass(frozen=True)
class External:
    """How a recruiting service names its study, the participant and their session there."""

    study: str
    participant: str
    session: str = ""

    @classmethod
    def from_query(cls, query: Mapping[str, str]) -> Self | None:
        """Prolific's three parameters, or None if the visitor comes without study and participant."""
        study, participant = query.get("STUDY_ID", "")[:LONGEST], query.get("PROLIFIC_PID", "")[:LONGEST]
        if not (study and participant):
            return None
        return cls(study, participant, query.get("SESSION_ID", "")[:LONGEST])

    @staticmethod
    def missing(query: Mapping[str, str]) -> str:
        """Which of the two names that belong together a link lacks, or has as the service's unfilled blank."""
        if not ("STUDY_ID" in query or "PROLIFIC_PID" in query):
            return ""
        wanted = ("STUDY_ID", "PROLIFIC_PID")
        return next((name for name in wanted if not query.get(name) or "{{" in query[name]), "")

    def as_query(self) -> dict[str, str]:
        """The parameters it came from, for a form's hidden fields."""
        return {"STUDY_ID": self.study, "PROLIFIC_PID": self.participant, "SESSION_ID": self.session}


def make_token(key: str, external: External | None) -> str:
    """A new token, or the one of this external person."""
    if external is None:
        nonce = secrets.token_bytes(BYTES)
        return written(nonce + proof(key, ANONYMOUS + nonce))
    nonce = proof(key, f"person\0{external.study}\0{external.participant}".encode())
    return written(nonce + proof(key, nonce))


def written(raw: bytes) -> str:
    """`raw` as it stands in an address."""
    return base64.urlsafe_b64encode(raw).decode().rstrip("=")


def is_valid(key: str, token: str) -> bool:
    """Whether `token` was made with `key`, to the letter: decoding alone passes over foreign and surplus ones."""
    try:
        raw = base64.urlsafe_b64decode(token + "=")
    except ValueError:
        return False
    if written(raw) != token or len(raw) != 2 * BYTES:
        return False
    return hmac.compare_digest(proof(key, raw[:BYTES]), raw[BYTES:]) or is_anonymous(key, token)


def is_anonymous(key: str, token: str) -> bool:
    """Whether a valid `token` is nobody's in particular. Those that release 1 gave are like external persons'."""
    raw = base64.urlsafe_b64decode(token + "=")
    return hmac.compare_digest(proof(key, ANONYMOUS + raw[:BYTES]), raw[BYTES:])


def belongs_to(key: str, token: str, external: External | None) -> bool:
    """Whether a valid `token` is the one of this external person, or of nobody in particular."""
    return is_anonymous(key, token) if external is None else hmac.compare_digest(token, make_token(key, external))


def proof(key: str, message: bytes) -> bytes:
    """128 bits that only the holder of `key` can compute from `message`."""
    return hmac.digest(key.encode(), message, hashlib.sha256)[:BYTES]


def pseudonym(salt: str, text: str) -> str:
    """A name for `text` that cannot be turned back without `salt`; for exports.

    One that spreadsheets and readers of CSV would take for a number, such as 12345e6789012345, gets a letter before it;
    the others stay what they were in earlier exports.
    """
    name = hmac.new(salt.encode(), text.encode(), hashlib.sha256).hexdigest()[:16]
    return f"p{name}" if NUMBER.fullmatch(name) else name
