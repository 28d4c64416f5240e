"""Counts wrong guesses of the secret: too many within a minute are told so. The right one is never kept waiting."""

import threading
import time
from collections import deque
from dataclasses import dataclass, field

GUESSES = 10
"""Wrong tries within `GUESS_WINDOW_S` seconds, from wherever they come, after which further wrong ones get 429."""

GUESS_WINDOW_S = 60.0


@dataclass
class Throttle:
    """The times of recent wrong guesses. In memory: no address of anybody is kept."""

    wrong: deque[float] = field(default_factory=lambda: deque(maxlen=GUESSES))
    lock: threading.Lock = field(default_factory=threading.Lock)

    def is_closed(self) -> bool:
        """Whether too many wrong guesses came lately."""
        with self.lock:
            return len(self.wrong) == GUESSES and time.monotonic() - self.wrong[0] < GUESS_WINDOW_S

    def note(self) -> None:
        """One more wrong guess."""
        with self.lock:
            self.wrong.append(time.monotonic())
