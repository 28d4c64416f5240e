"""One simulated participant's way through the survey, over HTTP, through the endpoints that the browser uses."""

import hashlib
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import httpx

from fakesss.problem import BadInput
from study_server.raters import Rater

PATIENCE_S = 120.0
"""How long a server that does not answer is waited for: long enough for a restart or an upgrade."""

DUPLICATE_EVERY = 7
"""Every so many saves the same answers are sent twice, as a browser does that has not seen the reply."""


@dataclass
class Walked:
    """What the server told this rater."""

    session: str = ""
    completion_code: str = ""
    acknowledged: dict[tuple[str, str, str], int] = field(default_factory=dict)
    """(session, trial, question) -> rating, as acknowledged."""
    save_ms: list[float] = field(default_factory=list)


def patiently(client: httpx.Client, method: str, path: str, **how: Any) -> httpx.Response:
    """A request repeated while there is no connection or the server is in trouble (5xx).

    Raises `BadInput` after `PATIENCE_S`, or if the server refuses.
    """
    deadline = time.monotonic() + PATIENCE_S
    wait = 0.05
    while True:
        try:
            response = client.request(method, path, **how)
            trouble = f"status {response.status_code}" if response.status_code >= 500 else ""
        except httpx.TransportError as error:
            trouble = str(error) or type(error).__name__
        if not trouble:
            break
        if time.monotonic() > deadline:
            raise BadInput(f"{client.base_url}: gave no answer for {PATIENCE_S:.0f} s ({trouble}); is it being served?")
        time.sleep(wait)
        wait = min(2 * wait, 2.0)
    if response.is_client_error:
        raise BadInput(f"{client.base_url}: refused {method} {path.split('/')[1]} ({response.text[:200]})")
    return response


def walk(url: str, rater: Rater, quits_after: int | None, saved: Callable[[], object]) -> Walked:
    """Take part until the end, or leave after `quits_after` rated pictures; `saved` is called after each picture.

    Raises `BadInput` if the server cannot be reached, refuses, or sends a picture that is not the one announced.
    """
    walked = Walked()
    with httpx.Client(
        base_url=url, headers={"Accept": "application/json"}, follow_redirects=True, timeout=30.0
    ) as client:
        state = patiently(client, "GET", "/").json()
        seen: set[str] = set()
        while state["step"] != "done":
            if state["step"] == "trials" and quits_after == state["trial"] - 1:
                return walked
            if state["step"] in ("practice", "trials"):
                look_at(client, state["picture"], seen)
                state = rate(client, rater, state, walked)
                saved()
            else:
                form = fill_in(rater, state)
                state = patiently(client, "POST", f"{state['here']}/{state['step']}", json=form).json()
            walked.session = state.get("session", "")
        walked.completion_code = state["completion_code"]
    return walked


def fill_in(rater: Rater, state: dict[str, Any]) -> dict[str, str]:
    """A form's answers: a program's consent, some choice for each question about the person, comments from a fifth."""
    if state["step"] == "consent":
        return {"simulated": "yes"}  # else these answers could not be told from people's
    if state["step"] == "about":
        random = rater.random(3)
        return {field["name"]: str(random.choice(field["choices"] or ["-"])) for field in state["fields"]}
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
    """Send the answers to one picture, sometimes twice, and note what was acknowledged; gives the next state."""
    random = rater.random(4, state["place"])
    stimulus = rater.study.by_id[state["stimulus"]]
    times = cumulated(random.lognormal(7.5, 0.4, len(state["questions"])))
    answers = [
        {"question": question["name"], "rating": rater.rating(stimulus, index), "rt_ms": times[index]}
        for index, question in enumerate(state["questions"])
    ]
    body = {
        "place": state["place"],
        "submission": f"simulated-{rater.seed}-{rater.number}-{state['place']}",
        "stimulus_sha256": state["picture"]["sha256"],
        "since_shown_ms": times[-1] + 300,
        "answers": answers,
        "display": display(state["picture"]["width"]),
    }
    for _ in range(2 if (rater.number + state["place"]) % DUPLICATE_EVERY == 0 else 1):
        begun = time.perf_counter()
        reply = patiently(client, "POST", f"{state['here']}/ratings", json=body).json()
        walked.save_ms.append((time.perf_counter() - begun) * 1000)
    if not state["practice"]:
        for row in reply["saved"]:
            walked.acknowledged[state["session"], str(state["trial"]), row["question"]] = row["rating"]
    following: dict[str, Any] = reply["next"]
    return following


def cumulated(gaps: Any) -> list[float]:
    """Response times of questions answered one after the other, ms."""
    return [round(float(gap), 1) for gap in gaps.cumsum()]


def display(width: int) -> dict[str, float]:
    """An ordinary screen at 100% zoom."""
    return {
        "device_pixel_ratio": 1,
        "zoom": 1,
        "drawn_width_px": width,
        "window_width_px": 1280,
        "window_height_px": 800,
        "focus_lost_ms": 0,
    }
