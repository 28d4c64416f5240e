"""PostgreSQL's writers: a transaction for each work, run again where the server says that nothing of it was kept."""

import random
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import TypeVar

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import DBAPIError

TRIES = 5
FIRST_WAIT_S = 0.01

UNDONE = {"40001": "serialization failure", "40P01": "deadlock", "23505": "lost the race for a key"}
"""SQLSTATEs after which nothing of the transaction was kept and a second run may find the way free."""

T = TypeVar("T")


class Retries:
    """All that this process writes to one PostgreSQL database, in as many transactions at once as the pool allows.

    Raises what the last try raised. A connection lost before COMMIT was sent has kept nothing, and the work is run
    again. One lost during COMMIT leaves open whether it was kept: then nothing is run again here, the caller gets the
    error and nobody is told "saved". The participant's browser sends the same submission again, and finds its row.
    """

    def __init__(self, engine: Engine, at_once: int) -> None:
        self.engine = engine
        self.at_once = at_once
        self.lock = threading.Lock()
        self.pool: ThreadPoolExecutor | None = None

    def submit(self, work: Callable[[Connection], T]) -> "Future[T]":
        """`work` is run in a thread of its own; the future gets its result when that is on disk, or the error."""
        with self.lock:
            if self.pool is None:
                self.pool = ThreadPoolExecutor(self.at_once, "writer")
            return self.pool.submit(self.run, work)

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """A transaction in the caller's thread; on disk when the block is left. It is not run again."""
        with self.engine.begin() as connection:
            yield connection

    def run(self, work: Callable[[Connection], T]) -> T:
        """The result of `work`, on disk."""
        for tries in range(1, TRIES + 1):
            committing = False
            try:
                with self.engine.connect() as connection, connection.begin() as transaction:
                    result = work(connection)
                    committing = True
                    transaction.commit()
                    return result
            except DBAPIError as error:
                if tries == TRIES or not nothing_was_kept(error, committing):
                    raise
            time.sleep(FIRST_WAIT_S * 2**tries * random.random())
        raise AssertionError("unreachable: the last try returns or raises")

    def close(self) -> None:
        """What was asked for is written, then the threads end; a write after that begins others."""
        with self.lock:
            pool, self.pool = self.pool, None
        if pool is not None:
            pool.shutdown()


def nothing_was_kept(error: DBAPIError, committing: bool) -> bool:
    """Whether it is certain that the transaction left nothing and worth while to try it again."""
    if error.connection_invalidated:
        return not committing
    return getattr(error.orig, "sqlstate", None) in UNDONE
