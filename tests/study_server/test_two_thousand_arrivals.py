"""People arrive, finish, fall silent, come back and withdraw, on a simulated clock: what holds of the rows, exactly.

A row's *places* are its finished and active sessions. The rule is one: a start takes the first of the rows with the
fewest places. Let `missing` be the starts that lift every row to at least one place below the fullest, so that max -
min <= 1 exactly when nothing is missing. From the rule follows, whatever happens in whichever order:

- a start lowers `missing` by one, or leaves it at 0: without drop-outs max - min <= 1 at any moment;
- someone who falls silent or withdraws raises it by 1 at the most, and the next arrivals fill those holes first;
- someone who comes back, to the row they had, raises it by the number of other rows at the most (rows - 1);
- nothing else changes it: who finishes keeps the place that they had.

So when nobody is under way any more, the finishers' rows are `missing` arrivals from max - min <= 1, no fewer.
"""

import heapq
from collections import Counter
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from random import Random

import pytest
from sqlalchemy import func, select
from study_fixture import write_study

from study_server import counts, sessions
from study_server.app import create_app
from study_server.guards.tokens import make_token
from study_server.site import Site

MINUTE = 60.0
START = 1_800_000_000.0
KINDS = ("start", "seen", "silent", "return", "finish", "withdraw")


def missing(places: list[int]) -> int:
    """Starts that lift every row to at least one place below the fullest."""
    return sum(max(0, max(places) - 1 - held) for held in places)


@dataclass
class World:
    """The study's database beside a plain account of who holds a place; every change of a place is judged."""

    site: Site
    row: dict[str, int] = field(default_factory=dict)
    under_way: dict[str, float] = field(default_factory=dict)  # token -> when last heard of
    places: list[int] = field(default_factory=list)
    seen: Counter[str] = field(default_factory=Counter)
    widest: int = 0

    def change(self, token: str, by: int, most: int) -> None:
        """One place more or less in this person's row; what is missing grows by `most` at the most."""
        before = missing(self.places)
        self.places[self.row[token]] += by
        assert missing(self.places) <= before + most
        self.widest = max(self.widest, max(self.places) - min(self.places))

    def release(self, now: float) -> None:
        """Who was silent for too long by `now` holds no place."""
        silence = sessions.release_s(self.site.study)
        for token in [token for token, at in self.under_way.items() if at <= now - silence]:
            del self.under_way[token]
            self.seen["silent"] += 1
            self.change(token, -1, most=1)

    def start(self, now: float) -> str:
        """Somebody new: they get the first of the emptiest rows, by our account and by the database's."""
        token = make_token(self.site.signing_key, None)
        before = missing(self.places)
        with self.site.database.writing() as connection:
            assert self.in_database(connection, now) == self.places
            visitor = sessions.Visitor(token, "live")
            self.row[token] = int(sessions.start(connection, self.site.study, visitor, now)["row"])
        assert self.row[token] == self.places.index(min(self.places))
        self.under_way[token] = now
        self.change(token, +1, most=0)
        assert missing(self.places) == max(0, before - 1)
        return token

    def in_database(self, connection: sessions.Connection, now: float) -> list[int]:
        """Places of each row as the database has them."""
        status = sessions.status(now, sessions.release_s(self.site.study))
        held = select(sessions.sessions.row, func.count()).where(status.in_(("finished", "active")))
        found = dict(connection.execute(held.group_by(sessions.sessions.row)).all())
        return [found.get(row, 0) for row in range(len(self.places))]

    def hear(self, token: str, now: float, *, finished: bool = False) -> None:
        """The person sends something, perhaps the last answer; after a long silence they take their place again."""
        with self.site.database.writing() as connection:
            session = sessions.find(connection, token)
            assert session is not None
            changes = {"finished_at": now} if finished else {}
            sessions.advance(connection, session, now, **changes)
        if token not in self.under_way:
            self.seen["return"] += 1
            self.change(token, +1, most=len(self.places) - 1)
        self.under_way[token] = now
        if finished:
            del self.under_way[token]

    def withdraw(self, token: str, now: float) -> None:
        """The person has everything deleted."""
        with self.site.database.writing() as connection:
            session = sessions.find(connection, token)
            assert session is not None
            sessions.withdraw(connection, session, now)
        if self.under_way.pop(token, None) is not None:
            self.change(token, -1, most=1)


def plans(random: Random, silence: float) -> list[tuple[float, str]]:
    """What one person does after the start: (seconds after it, what)."""
    at = 0.0
    plan = []
    while True:
        at += random.uniform(2, 12) * MINUTE
        fate = random.random()
        if fate < 0.50:
            plan.append((at, "seen"))
        elif fate < 0.80:
            return [*plan, (at, "finish")]
        elif fate < 0.83:
            return [*plan, (at, "withdraw")]
        elif fate < 0.91:
            return plan  # never comes back
        else:
            at += random.uniform(0.5, 4) * silence
            plan.append((at, "seen"))


def lived(world: World, people: int, random: Random) -> float:
    """`people` arrive and do what they do; returns the moment at which the last of them has finished or is released."""
    silence = sessions.release_s(world.site.study)
    order = count()
    now = START
    events = []
    for _ in range(people):
        now += random.expovariate(1 / (3 * MINUTE))
        heapq.heappush(events, (now, next(order), "start", ""))
    while events:
        now, _, kind, token = heapq.heappop(events)
        world.release(now)
        world.seen[kind] += 1
        if kind == "start":
            token = world.start(now)
            for later, what in plans(random, silence):
                heapq.heappush(events, (now + later, next(order), what, token))
        elif kind == "withdraw":
            world.withdraw(token, now)
        else:
            world.hear(token, now, finished=kind == "finish")
    now += silence
    world.release(now)
    return now


@pytest.mark.parametrize(("people", "pictures"), [(200, 3), pytest.param(2000, 9, marks=pytest.mark.long)])
def test_whoever_leaves_and_returns_the_next_arrivals_even_the_rows(tmp_path: Path, people: int, pictures: int) -> None:
    site = create_app(write_study(tmp_path, pictures)).state.site
    world = World(site, places=[0] * 2 * pictures)
    now = lived(world, people, Random(people))
    assert set(world.seen) == set(KINDS)
    assert min(world.seen.values()) >= people // 50  # each kind of thing did happen
    assert not world.under_way
    assert world.widest >= 2  # returns and drop-outs did upset the rows
    for left in range(missing(world.places), 0, -1):
        assert missing(world.places) == left
        assert max(world.places) - min(world.places) > 1
        world.hear(world.start(now), now, finished=True)
    with site.database.reading() as connection:
        figures = counts.overview(connection, site.study.identity, "live", now, sessions.release_s(site.study))
        finished = select(sessions.sessions.row).where(sessions.sessions.finished_at.is_not(None))
        finishers = Counter(connection.scalars(finished))
    assert [row["people"] for row in figures["rows"]] == world.places == [finishers[row] for row in range(2 * pictures)]
    assert max(finishers.values()) - min(finishers.values()) <= 1
    assert figures["active"] == 0


@pytest.mark.parametrize(("people", "pictures"), [(200, 3), pytest.param(2000, 9, marks=pytest.mark.long)])
def test_while_nobody_leaves_no_row_is_two_ahead(tmp_path: Path, people: int, pictures: int) -> None:
    site = create_app(write_study(tmp_path, pictures)).state.site
    world = World(site, places=[0] * 2 * pictures)
    random = Random(people)
    slow: list[str] = []
    for number in range(people):
        now = START + number  # all within release_after_minutes
        slow.append(world.start(now))
        if random.random() < 0.5:
            world.hear(slow.pop(random.randrange(len(slow))), now, finished=True)
        assert max(world.places) - min(world.places) <= 1
