"""Finishing pictures (encoding, hashing, writing) on threads while the next ones are drawn."""

import os
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import Self

THREADS = min(4, os.cpu_count() or 1)  # started only when those at work are all busy
WAITING = 2 * THREADS  # pictures; more would only be memory
MEMORY = 1 << 28  # bytes of pictures that may wait, except that one always may
BYTES_A_PIXEL = 16  # four 32-bit floats


class Background:
    """Does pieces of work in the order given, at most so many at once that memory stays flat.

    Nothing given is lost: leaving the block waits for all of it, also when an error or Ctrl-C ends the block. The
    error of a piece is raised by a later `submit` or, in a block without an error of its own, on leaving.
    """

    def __init__(self, size: tuple[int, int]) -> None:
        """`size`: width and height of the pictures that wait, in pixels."""
        self.limit = max(1, min(WAITING, MEMORY // (size[0] * size[1] * BYTES_A_PIXEL)))
        self.pending: deque[Future[None]] = deque()

    def __enter__(self) -> Self:
        self.pool = ThreadPoolExecutor(THREADS, thread_name_prefix="finish")
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.pool.shutdown(wait=True)
        while kind is None and self.pending:
            self.pending.popleft().result()

    def submit(self, work: Callable[[], None]) -> None:
        """Hand over `work`, then wait while too much is under way."""
        self.pending.append(self.pool.submit(work))
        while self.pending and (len(self.pending) > self.limit or self.pending[0].done()):
            self.pending.popleft().result()
