"""No real participant ever meets a limit: the fastest keys, an outbox after an outage, reload storms. A loop does."""

import logging
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest
from at_once import at_once
from study_fixture import write_study
from survey_client import JSON, Participant

from study_server.app import create_app
from study_server.guards.rate_limit import (
    AT_ONCE,
    PER_SECOND,
    SMALLEST_SWEEP,
    STARTS_AT_ONCE,
    Buckets,
    Limits,
    retry_after,
)
from study_server.guards.tokens import make_token
from study_server.serve import running

HELD_KEY_PER_S = 100 / 3
"""The fastest a keyboard repeats a key that is held down."""

OUTBOX = 20
"""The most answers a browser holds back (`unsaved_ahead`)."""


class Clock:
    """Seconds that pass when a test says so."""

    now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_a_bucket_empties_and_fills(clock: Clock) -> None:
    bucket = Buckets(per_second=2, at_once=3, clock=clock)
    assert [bucket.take("a") for _ in range(3)] == [0, 0, 0]
    assert bucket.take("a") == pytest.approx(0.5)
    assert bucket.take("b") == 0
    clock.now += 0.49
    assert bucket.take("a") == pytest.approx(0.01)
    clock.now += 0.01
    assert bucket.take("a") == 0
    clock.now += 1000
    assert [bucket.take("a") > 0 for _ in range(4)] == [False, False, False, True]


def test_being_refused_costs_nothing(clock: Clock) -> None:
    bucket = Buckets(per_second=1, at_once=1, clock=clock)
    bucket.take()
    for _ in range(100):
        assert bucket.take() > 0
    clock.now += 1
    assert bucket.take() == 0


def test_leaning_on_a_key_is_never_refused(clock: Clock) -> None:
    limits = Limits(posts=Buckets(PER_SECOND, AT_ONCE, clock), views=Buckets(PER_SECOND, AT_ONCE, clock))
    for _ in range(20_000):  # ten minutes
        clock.now += 1 / HELD_KEY_PER_S
        assert limits.session("token", "POST") == limits.session("token", "GET") == 0


def test_an_outbox_is_never_refused(clock: Clock) -> None:
    limits = Limits(posts=Buckets(PER_SECOND, AT_ONCE, clock))
    assert all(limits.session("token", "POST") == 0 for _ in range(2 * 5 * OUTBOX))  # two tabs, five tries


def test_a_class_may_come_at_once_and_a_script_of_thousands_may_not(clock: Clock) -> None:
    limits = Limits()
    limits.people.clock = limits.programs.clock = clock
    assert all(limits.start(simulated=False) == 0 for _ in range(400))
    clock.now += 3600
    refused = sum(limits.start(simulated=False) > 0 for _ in range(10_000))
    assert refused == 10_000 - STARTS_AT_ONCE
    assert all(limits.start(simulated=True) == 0 for _ in range(2000))  # they have a bucket of their own


def test_memory_holds_only_who_asked_lately(clock: Clock) -> None:
    bucket = Buckets(PER_SECOND, AT_ONCE, clock)
    most = 0
    for number in range(20_000):
        clock.now += 0.001
        bucket.take(str(number))
        most = max(most, len(bucket.full_at))
    assert most <= SMALLEST_SWEEP + 1


def test_retry_after_is_whole_seconds() -> None:
    assert retry_after(0.01) == {"Retry-After": "1"}
    assert retry_after(2.2) == {"Retry-After": "3"}


def test_real_bursts_pass_and_a_loop_does_not(url: str) -> None:
    """Over HTTP: an outbox by two tabs, then F5 held down, then a loop, which is told how long to wait."""
    person = Participant(url).to_trials()
    body = person.answers()
    assert {reply.status for reply in at_once(url, [(f"{person.here}/ratings", body)] * 2 * OUTBOX)} == {200}
    person.state = person.client.get(person.here).json()
    with httpx.Client(base_url=url) as client:
        end = time.monotonic() + 2
        while time.monotonic() < end:
            began = time.monotonic()
            assert client.get(person.here).status_code == 200
            time.sleep(max(0.0, 1 / HELD_KEY_PER_S - (time.monotonic() - began)))

    def loop(_: int) -> httpx.Response:
        with httpx.Client(base_url=url, headers=JSON) as client:
            while (reply := client.get(f"{person.here}/about")).status_code == 303:
                pass
            return reply

    with ThreadPoolExecutor(4) as pool:
        replies = list(pool.map(loop, range(4)))
    for reply in replies:
        assert reply.status_code == 429
        assert int(reply.headers["retry-after"]) >= 1
        assert "Nothing is lost" in reply.json()["error"]
    other = Participant(url).to_trials()  # somebody else notices nothing
    assert other.rate()["saved"]
    assert person.rate()["saved"]  # answers have a bucket of their own


def test_strangers_cost_no_database(study: Path) -> None:
    """An address that this server did not make is refused before the database is asked."""
    app = create_app(study)
    with running(app) as url, httpx.Client(base_url=url, headers=JSON) as client:
        app.state.site.database.engine.connect = None  # whoever asks it falls over
        foreign = f"/s/{make_token('another key', None)}"
        for step in ("ratings", "about", "consent", "withdraw", "comments", "nonsense", "declined"):
            assert client.post(f"{foreign}/{step}").status_code == 404
        assert client.get(foreign).status_code == client.get(f"{foreign}/withdraw").status_code == 404
        answers = {
            "place": 0,
            "submission": "12345678",
            "stimulus_sha256": "0" * 64,
            "since_shown_ms": 1,
            "answers": [],
        }
        display = dict.fromkeys(
            ("device_pixel_ratio", "zoom", "drawn_width_px", "window_width_px", "window_height_px", "focus_lost_ms"), 1
        )
        assert client.post(f"{foreign}/ratings", json=answers | {"display": display}).status_code == 404


def test_too_many_starts_are_asked_to_wait_and_said(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    app = create_app(write_study(tmp_path))
    app.state.site.limits.people = Buckets(per_second=0.01, at_once=2)
    with running(app) as url, caplog.at_level(logging.WARNING):
        people = [Participant(url).consent() for _ in range(2)]
        late = Participant(url)
        for _ in range(3):
            reply = late.client.post(f"{late.here}/consent")
            assert (reply.status_code, reply.json()["error"][:11]) == (429, "Many people")
            assert int(reply.headers["retry-after"]) > 10
        assert people[0].post("consent")["step"] == "about"  # who has started is not asked to wait
        assert late.client.post(f"{late.here}/consent", json={"simulated": "yes"}).status_code == 200
    assert caplog.text.count("more sessions are being started") == 1
