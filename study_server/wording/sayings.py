"""What single values of [survey] may be: each function gives its value, or `ValueError` with the sentence."""

import re
from collections.abc import Collection

ADDRESS = re.compile(r"https?://\S+")
ORIGIN = re.compile(r"https?://(\*\.)?[A-Za-z0-9.-]+(:\d+)?")
BLANK = re.compile(r"\{\w+\}")


def choice(text: str) -> str:
    """One of a question's choices, without blanks around it: forms send them back as browsers like."""
    stripped = text.strip()
    if not stripped or not stripped.isprintable():
        raise ValueError("a choice is one line with something to read on it")
    return stripped


def code(text: str) -> str:
    """A completion code, or "" for none."""
    if "://" in text:
        raise ValueError("is an address; write only the code, as what follows cc= in it")
    if text != text.strip() or not text.isprintable():
        raise ValueError("has blanks around it, or no visible letters; write the code alone")
    return text


def return_url(text: str) -> str:
    """Where the last page leads, or "" for nowhere of the study's own."""
    if text and not ADDRESS.fullmatch(text):
        raise ValueError("is no address; write it whole, as https://lab.example/thanks")
    return with_blanks(text, ("{code}",))


def origin(text: str) -> str:
    """A site: scheme and host, a port if it has one."""
    if not ORIGIN.fullmatch(text):
        raise ValueError("is no site; write scheme and host alone, as https://lab.example or https://*.lab.example")
    return text


def instructions(text: str) -> str:
    """What is read before practice."""
    return with_blanks(text, ("{questions}", "{scale}", "{keys}"))


def with_blanks(text: str, known: Collection[str]) -> str:
    """`text`, if nothing in it looks like a blank and is none."""
    unknown = [blank for blank in BLANK.findall(text) if blank not in known]
    if unknown:
        raise ValueError(f"{unknown[0]} is not filled in; choose among {', '.join(known)}")
    return text


def other_blanks(text: str, translation: str) -> str:
    """What is wrong with the {blanks} of a translation; empty if they are those of the text."""
    wanted, found = (sorted(set(BLANK.findall(written))) for written in (text, translation))
    if wanted == found:
        return ""
    return f"its blanks must be those of the text, {', '.join(wanted) or 'none'}, not {', '.join(found) or 'none'}"
