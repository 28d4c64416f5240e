"""How often one session may ask: more than a person can, much less than a loop does. In memory; no address is kept.

What it is not: a defence against somebody with a thousand sessions. Each process counts for itself, so that N workers
allow N times as much.
"""

import logging
import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

log = logging.getLogger(__name__)

PER_SECOND, AT_ONCE = 40.0, 200
"""Of one session's posts, and as many of its pages. Keyboards repeat a key that is held down 33 times a second at most
(macOS 15 ms x 2, Windows 30/s, X11 25/s): whoever leans on a key that answers, or on F5, asks less often than this for
as long as they like. At once: an outbox of 20 answers sent after an outage, each five times, by two tabs."""

STARTS_PER_SECOND, STARTS_AT_ONCE = 2.0, 600
"""Of all new sessions of people together: a class of 400 that opens the link in one minute has half as many to spare.
10,000 scripted consents take an hour and twenty minutes, which the researcher sees at /admin and can pause."""

SIMULATED_PER_SECOND, SIMULATED_AT_ONCE = 100.0, 3000
"""Of sessions that say that they are simulated: they take nobody's place, so that only the disk is guarded."""

SMALLEST_SWEEP = 1000


@dataclass
class Buckets:
    """Token buckets, one a key, as the generic cell rate algorithm has them (ITU-T I.371): a time each.

    `full_at` is when a key's bucket is full again. One that is full is as good as none and is swept away, so that
    memory holds the keys of the last `at_once / per_second` seconds only.
    """

    per_second: float
    at_once: int
    clock: Callable[[], float] = time.monotonic
    full_at: dict[str, float] = field(default_factory=dict)
    sweep_at: int = SMALLEST_SWEEP
    lock: threading.Lock = field(default_factory=threading.Lock)

    def take(self, key: str = "") -> float:
        """0 if `key` may go on, which is counted; else for how many seconds it is to wait, which is not."""
        with self.lock:
            now = self.clock()
            full_at = max(self.full_at.get(key, now), now) + 1 / self.per_second
            wait = full_at - now - self.at_once / self.per_second
            if wait > 1e-9:
                return wait
            self.full_at[key] = full_at
            if len(self.full_at) > self.sweep_at:
                self.full_at = {key: at for key, at in self.full_at.items() if at > now}
                self.sweep_at = max(SMALLEST_SWEEP, 2 * len(self.full_at))
            return 0.0


def per_session() -> Buckets:
    """Of posts, or of pages."""
    return Buckets(PER_SECOND, AT_ONCE)


def starts_of_people() -> Buckets:
    """Of new sessions."""
    return Buckets(STARTS_PER_SECOND, STARTS_AT_ONCE)


def starts_of_programs() -> Buckets:
    """Of new simulated sessions."""
    return Buckets(SIMULATED_PER_SECOND, SIMULATED_AT_ONCE)


@dataclass
class Limits:
    """Everything that is counted of one served study."""

    posts: Buckets = field(default_factory=per_session)
    views: Buckets = field(default_factory=per_session)
    people: Buckets = field(default_factory=starts_of_people)
    programs: Buckets = field(default_factory=starts_of_programs)
    warned: Buckets = field(default_factory=lambda: Buckets(1 / 60, 1))

    def session(self, token: str, method: str) -> float:
        """0, or the seconds that this session is to wait before it asks again."""
        return (self.views if method in ("GET", "HEAD") else self.posts).take(token)

    def start(self, *, simulated: bool) -> float:
        """0, or the seconds until one more session can begin; the researcher is told, once a minute."""
        wait = (self.programs if simulated else self.people).take()
        if wait and not self.warned.take():
            log.warning("more sessions are being started than a crowd of people starts: some were asked to wait")
        return wait


def retry_after(wait: float) -> dict[str, str]:
    """The header that says so, in whole seconds (RFC 9110, 10.2.3)."""
    return {"Retry-After": str(max(1, math.ceil(wait)))}
