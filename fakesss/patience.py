"""Long work asks between its parts whether anybody still waits for it; who started it says so."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar


class Unwanted(Exception):
    """The work was given up: nobody waits for it any more."""


def always() -> bool:
    return True


_is_wanted: ContextVar[Callable[[], bool]] = ContextVar("is_wanted", default=always)


@contextmanager
def while_wanted(is_wanted: Callable[[], bool]) -> Iterator[None]:
    """Work in the block, on this thread, goes on only as long as `is_wanted()`."""
    token = _is_wanted.set(is_wanted)
    try:
        yield
    finally:
        _is_wanted.reset(token)


def is_wanted() -> bool:
    """Whether somebody waits for the work at hand."""
    return _is_wanted.get()()
