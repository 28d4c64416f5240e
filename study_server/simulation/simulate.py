"""Bots first: simulated raters over HTTP against a served study, and what became of every acknowledged answer."""

import csv
import io
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from random import Random
from typing import Any

import httpx
import numpy as np
from tqdm import tqdm

from fakesss.problem import BadInput
from study_server.manifest import BuiltStudy
from study_server.pages import trials
from study_server.simulation.raters import Effects, Rater, default_effects, load_effects
from study_server.simulation.walk import Walked, patiently, walk

STARTED, COMPLETED = 44, 38
"""How many begin and how many of them finish, unless told: a class of students."""

AT_ONCE = 8
"""Raters under way at the same time."""

Key = tuple[str, str, str]


def simulate(
    url: str,
    study: BuiltStudy,
    admin_secret: str,
    *,
    started: int = STARTED,
    completed: int | None = None,
    seed: int = 1,
    effects: Effects | Path | None = None,
    progress: bool = True,
) -> dict[str, Any]:
    """`started` raters take part at `url`, `completed` of them to the end; outlives restarts of the server.

    `completed` left out is as large a share of `started` as 38 of 44.
    They are of mode simulated whatever mode the server serves. Simulated raters of earlier runs are counted first and
    the new ones numbered after them, so that the same seed brings new people rather than the same ones again.
    Returns the shape of `fakesss simulate --json`: raters started and completed; ratings acknowledged by the server;
    of these, stored (found in the export that the server sends), lost (not found with that value) and duplicated
    (further rows with the same session, trial and question); median and 99th percentile of a save in ms.
    Raises `BadInput` for counts that make no sense, effects that are not of the study, an address that is none, a
    server out of reach, or one that serves another study.
    """
    if completed is None:
        completed = completing(started)
    if not 0 <= completed <= started:
        raise BadInput(f"--completed {completed}: must be between 0 and --started {started}")
    if isinstance(effects, Path):
        effects = load_effects(effects, study)
    first = raters_before(url, study, admin_secret)
    raters = [Rater(study, effects or default_effects(study), seed, first + number) for number in range(started)]
    quits = quitting(started, completed, trials(study), seed)
    with tqdm(total=pictures(study, quits), unit="picture", disable=None if progress else True) as bar:
        walks = all_walks(url, raters, quits, bar)
    acknowledged = {key: rating for walked in walks for key, rating in walked.acknowledged.items()}
    exported = exported_ratings(url, admin_secret, {walked.session for walked in walks})
    waits = [ms for walked in walks for ms in walked.save_ms] or [0.0]
    return {
        "started": started,
        "completed": sum(bool(walked.completion_code) for walked in walks),
        "acknowledged": len(acknowledged),
        "stored": len(exported),
        "lost": sum(rating not in exported.get(key, []) for key, rating in acknowledged.items()),
        "duplicated": sum(len(found) - 1 for found in exported.values()),
        "p50_ms": round(float(np.percentile(waits, 50)), 2),
        "p99_ms": round(float(np.percentile(waits, 99)), 2),
        "base_url": url,
    }


def completing(started: int) -> int:
    """How many of `started` raters stay to the end where nobody says how many."""
    return round(started * COMPLETED / STARTED)


def quitting(started: int, completed: int, pictures: int, seed: int) -> list[int | None]:
    """For each rater the number of pictures after which they leave, or None: exactly `completed` stay."""
    random = Random(f"quitting {seed}")
    leavers = set(random.sample(range(started), started - completed))
    return [random.randrange(pictures) if number in leavers else None for number in range(started)]


def pictures(study: BuiltStudy, quits: list[int | None]) -> int:
    """How many pictures will be rated in all, practice included."""
    practice = study.settings.survey.practice
    return sum(practice + (trials(study) if quit_after is None else quit_after) for quit_after in quits)


def all_walks(url: str, raters: list[Rater], quits: list[int | None], bar: "tqdm[Any]") -> list[Walked]:
    """Everybody's walk, several at once; the first failure ends the simulation."""
    with ThreadPoolExecutor(AT_ONCE) as pool:
        walks = [
            pool.submit(walk, url, rater, quits_after, bar.update)
            for rater, quits_after in zip(raters, quits, strict=True)
        ]
        try:
            return [walked.result() for walked in walks]
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def raters_before(url: str, study: BuiltStudy, admin_secret: str) -> int:
    """How many simulated raters the server at `url` knows already; `BadInput` unless it serves this very study."""
    check_address(url)
    with httpx.Client(base_url=url, follow_redirects=True, timeout=30.0) as client:
        health = patiently(client, "GET", "/health")
    try:
        identity = health.json()["identity"]
    except (ValueError, KeyError, TypeError):  # some other program answers there
        identity = ""
    if identity != study.identity:
        raise BadInput(f"{url}: serves another study than {study.folder}, or another version of it; give its address")
    return len(exported_rows(url, admin_secret, "participants"))


def check_address(url: str) -> None:
    """`BadInput` unless `url` can be an address at all: asking again and again would not mend it."""
    try:
        address = httpx.URL(url)
    except httpx.InvalidURL as error:
        raise BadInput(f"{url!r}: is no address ({error}); write http://HOST:PORT") from None
    if address.scheme not in ("http", "https") or not address.host:
        raise BadInput(f"{url!r}: is no address of a survey; write http://HOST:PORT")


def exported_rows(url: str, admin_secret: str, table: str) -> list[dict[str, str]]:
    """A table of the export of all simulated raters, as a reader of the CSV finds it."""
    with httpx.Client(base_url=url, headers={"Authorization": f"Bearer {admin_secret}"}, timeout=120.0) as client:
        text = patiently(client, "GET", f"/admin/export/{table}.csv", params={"mode": "simulated"}).text
    return list(csv.DictReader(io.StringIO(text)))


def exported_ratings(url: str, admin_secret: str, sessions: set[str]) -> dict[Key, list[int]]:
    """The ratings of these sessions in the export."""
    found: dict[Key, list[int]] = {}
    for row in exported_rows(url, admin_secret, "ratings"):
        if row["session"] in sessions and row["rating"]:
            found.setdefault((row["session"], row["trial"], row["question"]), []).append(int(row["rating"]))
    return found
