"""One simulated participant's way through the survey, over HTTP, through the endpoints that the browser uses."""

import hashlib
import re
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import httpx

from fakesss.problem import BadInput
from study_server.screen import screen_check
from study_server.settings import CHECK_NAME
from study_server.simulation.raters import Rater

PATIENCE_S = 120.0
"""How long a server that does not answer is waited for: long enough for a restart or an upgrade."""

DUPLICATE_EVERY = 7
"""Every so many saves the same answers are sent twice, as a browser does that has not seen the reply."""


MISTYPED_EVERY = 3
"""Every so many pictures a clumsy rater corrects an answer after it was saved."""


@dataclass
class Walked:
    """What the server told this rater."""

    session: str = ""
    completion_code: str = ""
    acknowledged: dict[tuple[str, str, str], int] = field(default_factory=dict)
    """(session, trial, question) -> rating, as acknowledged."""
    save_ms: list[float] = field(default_factory=list)


def patiently(client: httpx.Client, method: str, path: str, *, answered: int = 200, **how: Any) -> httpx.Response:
    """A request repeated while there is no connection, the server is in trouble (5xx) or asks to wait (429).

    Raises `BadInput` after `PATIENCE_S`, or if the server refuses, except with the status `answered`.
    """
    deadline = time.monotonic() + PATIENCE_S
    wait = 0.05
    while True:
        try:
            response = client.request(method, path, **how)
            trouble = f"status {response.status_code}" if response.status_code >= 500 else ""
            trouble = trouble or ("too many requests" if response.status_code == 429 else "")
        except httpx.TransportError as error:
            trouble = str(error) or type(error).__name__
        if not trouble:
            break
        if time.monotonic() > deadline:
            raise BadInput(f"{client.base_url}: gave no answer for {PATIENCE_S:.0f} s ({trouble}); is it being served?")
        time.sleep(wait)
        wait = min(2 * wait, 2.0)
    if response.is_client_error and response.status_code != answered:
        raise BadInput(f"{client.base_url}: refused {method} {path.split('/')[1]} ({response.text[:200]})")
    return response


def walk(url: str, rater: Rater, quits_after: int | None, saved: Callable[[], object]) -> Walked:
    """Take part until the end, or leave after `quits_after` rated pictures; `saved` is called after each picture.

    Raises `BadInput` if the server cannot be reached, refuses, lets nobody in or on, or sends a picture that is not the
    one announced.
    """
    walked = Walked()
    with httpx.Client(
        base_url=url, headers={"Accept": "application/json"}, follow_redirects=True, timeout=30.0
    ) as client:
        state = patiently(client, "GET", "/").json()
        seen: set[str] = set()
        while state["step"] != "done":
            if state["step"] in ("paused", "closed"):
                raise BadInput(f"{url}: the study is {state['step']}; open it at /admin")
            if state["step"] == "trials" and quits_after == state["trial"] - 1:
                return walked
            if state["step"] in ("practice", "trials"):
                look_at(client, state["picture"], seen)
                state = rate(client, rater, state, walked)
                saved()
            else:
                state = leave(client, rater, state)
            if rater.is_clumsy:
                state = patiently(client, "GET", state["here"]).json()  # a reload shows the same page
            walked.session = state.get("session", "")
        walked.completion_code = state["completion_code"]
    return walked


def leave(client: httpx.Client, rater: Rater, state: dict[str, Any]) -> dict[str, Any]:
    """Send this page's form; gives the next state. `BadInput` if that is the same page: it would be so for ever."""
    step = state["step"]
    form = fill_in(rater, state)
    following: dict[str, Any] = patiently(client, "POST", f"{state['here']}/{step}", answered=422, json=form).json()
    if "error" in following or following["step"] == step:
        raise BadInput(
            f'{client.base_url}: the page "{step}" takes no answer and stays; look at it in a browser, and mend its '
            "questions in study.toml (a choice that can be taken and does not screen out)"
        )
    return following


def fill_in(rater: Rater, state: dict[str, Any]) -> dict[str, str]:
    """A form's answers: a program's consent, some choice for each question about the person, a screen,
    comments from a fifth."""
    if state["step"] == "consent":
        return {"simulated": "yes"}  # else these answers could not be told from people's
    if state["step"] == "about":
        random = rater.random(3)
        fields = rater.study.settings.survey.about
        staying = {field.name: [each for each in field.choices if each not in field.screen_out] for field in fields}
        return {name: str(random.choice(choices or ["-"])) for name, choices in staying.items()}
    if state["step"] == "screen":
        return screen_check.simulated(rater.random(8), rater.study.settings.survey.screen_check)
    if state["step"] == "comments" and rater.number % 5 == 0:
        return {"comments": "Some pictures looked alike to me."}
    return {}


def look_at(client: httpx.Client, picture: dict[str, Any], seen: set[str]) -> None:
    """Fetch the picture and compare its hash, once, as a browser with a cache does."""
    if picture["sha256"] in seen:
        return
    data = patiently(client, "GET", picture["url"]).content
    if hashlib.sha256(data).hexdigest() != picture["sha256"]:
        raise BadInput(f"{client.base_url}: sent a picture whose SHA-256 is not {picture['sha256']}; build it again")
    seen.add(picture["sha256"])


def rate(client: httpx.Client, rater: Rater, state: dict[str, Any], walked: Walked) -> dict[str, Any]:
    """Send the answers to one picture, sometimes twice, and note what was acknowledged; gives the next state.

    A clumsy rater mistypes every third picture and corrects it: two submissions, of which the second counts.
    """
    random = rater.random(4, state["place"])
    pace = 3 if rater.is_slow else 1
    times = cumulated(pace * random.lognormal(7.5, 0.4, len(state["questions"])))
    given = {question["name"]: chosen(rater, state, question) for question in state["questions"]}
    is_twice = rater.is_clumsy or (rater.number + state["place"]) % DUPLICATE_EVERY == 0
    tries = [given] * (2 if is_twice else 1)
    if rater.is_clumsy and state["place"] % MISTYPED_EVERY == 0:
        tries = [mistyped(given, state["questions"]), *tries]
    for ratings in tries:
        body = posted(rater, state, ratings, times, "" if ratings == given else "-mistyped")
        begun = time.perf_counter()
        reply = patiently(client, "POST", f"{state['here']}/ratings", json=body).json()
        walked.save_ms.append((time.perf_counter() - begun) * 1000)
    if not state["practice"]:
        for row in reply["saved"]:
            walked.acknowledged[state["session"], str(state["trial"]), row["question"]] = row["rating"]
    following: dict[str, Any] = reply["next"]
    return following


def chosen(rater: Rater, state: dict[str, Any], question: dict[str, Any]) -> int:
    """The answer to one question. An instructed item is obeyed; a clumsy rater overlooks every other one."""
    if question["name"] != CHECK_NAME:
        return rater.rating(rater.study.by_id[state["stimulus"]], question["name"])
    asked = re.search(r"\d+", question["text"])
    assert asked, f"an instructed item without a number: {question['text']}"
    overlooked = rater.is_clumsy and bool(rater.random(7, state["place"]).random() < 0.5)
    return (question["scale"] + 1) // 2 if overlooked else int(asked[0])


def mistyped(given: dict[str, int], questions: list[dict[str, Any]]) -> dict[str, int]:
    """The first answer a step off."""
    first = questions[0]
    wrong = given[first["name"]] + (1 if given[first["name"]] < first["scale"] else -1)
    return given | {first["name"]: wrong}


def posted(
    rater: Rater, state: dict[str, Any], ratings: dict[str, int], times: list[float], mark: str
) -> dict[str, Any]:
    """The body that a browser would send."""
    return {
        "place": state["place"],
        "submission": f"simulated-{rater.seed}-{rater.number}-{state['place']}{mark}",
        "stimulus_sha256": state["picture"]["sha256"],
        "since_shown_ms": times[-1] + 300,
        "answers": [
            {"question": name, "rating": rating, "rt_ms": ms}
            for (name, rating), ms in zip(ratings.items(), times, strict=True)
        ],
        "display": display(state["picture"]),
    }


def cumulated(gaps: Any) -> list[float]:
    """Response times of questions answered one after the other, ms."""
    return [round(float(gap), 1) for gap in gaps.cumsum()]


def display(picture: dict[str, Any]) -> dict[str, Any]:
    """An ordinary screen at 100% zoom."""
    return {
        "device_pixel_ratio": 1,
        "zoom": 1,
        "drawn_width_px": picture["width"],
        "drawn_height_px": picture["height"],
        "scaled": False,
        "gamut": "srgb",
        "window_width_px": 1280,
        "window_height_px": 800,
        "focus_lost_ms": 0,
    }
