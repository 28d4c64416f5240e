"""SQLite's one writer: a thread that brings what several callers wait for to disk with one commit.

A commit waits for the disk, often for milliseconds; the statements of a rating take fractions of one. So whoever asks
while a commit is under way shares the next one with all others who do: a group commit (DeWitt et al. 1984,
"Implementation techniques for main memory database systems"). Each work stands in a savepoint of its own.
"""

import math
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeVar

from sqlalchemy import Connection, Engine

from study_server.storage.engines import empty_log

GROUP_WORKS = 64
"""The most works in one commit."""

GROUP_S = 0.02
"""After so long a group takes nobody in any more: one slow work holds up only those who are with it already."""

LOG_WAIT_S = 0.05
"""How long all writers wait for readers that still need the log, so that it can be emptied."""

LOG_AGAIN_S = 1.0
"""After so long it is tried again: an export of a large study needs the log for minutes."""

T = TypeVar("T")


@dataclass(frozen=True)
class Job:
    """Something to be written, with others if they are there, and who waits for it."""

    work: Callable[[Connection], Any]
    future: "Future[Any]" = field(default_factory=Future)


@dataclass(frozen=True)
class Turn:
    """A caller who wants the writer's place for a transaction of their own thread."""

    begun: threading.Event = field(default_factory=threading.Event)
    ended: threading.Event = field(default_factory=threading.Event)


@dataclass(frozen=True)
class EmptyLog:
    """Somebody wants that what was deleted is gone from the log too."""

    tried: threading.Event = field(default_factory=threading.Event)


@dataclass(frozen=True)
class Line:
    """Who waits, first come first served; None at its end closes it."""

    waiting: deque[Job | Turn | EmptyLog | None] = field(default_factory=deque)
    somebody: threading.Condition = field(default_factory=threading.Condition)

    def put(self, item: Job | Turn | EmptyLog | None) -> None:
        """Somebody more."""
        with self.somebody:
            self.waiting.append(item)
            self.somebody.notify()

    def get(self, until: float) -> Job | Turn | EmptyLog | None:
        """The first one, waited for; at the time `until` (`time.monotonic`) it is the log's turn."""
        with self.somebody:
            wait_s = None if until == math.inf else max(0.0, until - time.monotonic())
            self.somebody.wait_for(lambda: self.waiting, wait_s)
            return self.waiting.popleft() if self.waiting and time.monotonic() < until else EmptyLog()

    def get_job(self) -> Job | None:
        """The first one if that is a job and there now; a turn stays where it is."""
        with self.somebody:
            first = self.waiting[0] if self.waiting else None
            if isinstance(first, Job):
                self.waiting.popleft()
                return first
            return None


class GroupCommit:
    """All that this process writes to one SQLite database, in the order of asking.

    The thread begins with the first write and ends with `close`; a write after that begins another.
    """

    def __init__(self, engine: Engine) -> None:
        self.engine = engine.execution_options(sqlite_begin="IMMEDIATE")
        self.lock = threading.Lock()
        self.line: Line | None = None
        self.thread: threading.Thread | None = None
        self.holder: int | None = None  # the thread whose turn it is

    def submit(self, work: Callable[[Connection], T]) -> "Future[T]":
        """`work` is run in the writer's thread; the future gets its result when that is on disk, or the error.

        What was asked for is done: the future cannot be cancelled.
        """
        job = Job(work)
        job.future.set_running_or_notify_cancel()
        self.enter(job)
        return job.future

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """A transaction in the caller's thread; on disk when the block is left."""
        turn = Turn()
        self.enter(turn)
        turn.begun.wait()
        self.holder = threading.get_ident()
        try:
            with self.engine.begin() as connection:
                yield connection
        finally:
            self.holder = None
            turn.ended.set()

    def empty_log(self) -> None:
        """What was deleted is gone from SQLite's log when this returns, or else once nobody reads older snapshots."""
        item = EmptyLog()
        self.enter(item)
        item.tried.wait()

    def enter(self, item: Job | Turn | EmptyLog) -> None:
        """A place in the line. `RuntimeError` for who is the writer already and would wait for themselves."""
        with self.lock:
            if threading.get_ident() in (self.holder, self.thread and self.thread.ident):
                raise RuntimeError("a transaction is begun inside a transaction: use the connection that is there")
            if self.line is None:
                self.line = Line()
                self.thread = threading.Thread(
                    target=write_all, args=(self.engine, self.line), name="writer", daemon=True
                )
                self.thread.start()
            self.line.put(item)

    def close(self) -> None:
        """What was asked for is written, then the thread ends."""
        with self.lock:
            line, thread = self.line, self.thread
            self.line = self.thread = None
        if line is not None and thread is not None:
            line.put(None)
            if thread is not threading.current_thread():  # which may drop the last reference to the database
                thread.join()


def write_all(engine: Engine, line: Line) -> None:
    """The writer's thread: groups of jobs and single turns until the line is closed.

    It empties the log soon after it began, for a process that was killed may have left deletions in it.
    """
    again_at = time.monotonic() + LOG_AGAIN_S
    while (item := line.get(again_at)) is not None:
        if isinstance(item, Turn):
            item.begun.set()
            item.ended.wait()
        elif isinstance(item, EmptyLog):
            is_empty = empty_log(engine, LOG_WAIT_S)
            again_at = math.inf if is_empty else time.monotonic() + LOG_AGAIN_S
            item.tried.set()
        else:
            commit_group(engine, line, item)


def commit_group(engine: Engine, line: Line, first: Job) -> None:
    """Run `first` and the jobs right behind it, commit, and only then answer.

    If the transaction fails (the disk is full), all get that error, those too whose work had failed by itself: what
    made it fail may have been a neighbour's row that is not there now.
    """
    jobs, outcomes = [], []
    until = time.monotonic() + GROUP_S
    job: Job | None = first
    try:
        jobs.append(first)
        with engine.begin() as connection:
            while job is not None:
                outcomes.append(attempt(connection, job))
                more = len(jobs) < GROUP_WORKS and time.monotonic() < until
                job = line.get_job() if more else None
                jobs += [job] if job else []
    except BaseException as error:  # whatever it is, nobody must be left waiting
        outcomes = [(None, error)] * len(jobs)
    for done, (result, failure) in zip(jobs, outcomes, strict=True):
        if failure is None:
            done.future.set_result(result)
        else:
            done.future.set_exception(failure)


def attempt(connection: Connection, job: Job) -> tuple[Any, BaseException | None]:
    """Result or error of one job; an error undoes that job alone.

    Raises the error if SQLite has ended the whole transaction over it, as it does when the disk is full.
    """
    sqlite: Any = connection.connection.driver_connection  # SQLAlchemy's own savepoints take longer than a commit
    sqlite.execute("SAVEPOINT job")
    try:
        result = job.work(connection)
        sqlite.execute("RELEASE job")
    except BaseException as error:
        if not sqlite.in_transaction:
            raise
        sqlite.execute("ROLLBACK TO job")
        sqlite.execute("RELEASE job")
        return None, error
    return result, None
