"""The researcher's pages: locked, throttled, and with one count for everything."""

from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest
from survey_client import JSON, Participant

from fakesss.problem import BadInput
from study_server.app import admin_secret, create_app
from study_server.guards.throttle import GUESSES
from study_server.serve import served

Exported = Callable[..., list[dict[str, str]]]


@pytest.fixture
def admin(study: Path, url: str) -> Iterator[httpx.Client]:
    headers = {**JSON, "Authorization": f"Bearer {admin_secret(study)}"}
    with httpx.Client(base_url=url, headers=headers) as client:
        yield client


@pytest.mark.parametrize(
    "path", ["/admin", "/admin/backup", "/admin/export/ratings.csv", "/admin/report/", "/admin/report/x.svg"]
)
def test_nothing_without_the_secret(url: str, path: str) -> None:
    response = httpx.get(f"{url}{path}", headers={**JSON, "Authorization": "Bearer wrong"})
    assert response.status_code == 401
    assert response.json()["step"] == "login"


def test_the_cookie_opens_and_a_forged_one_does_not(url: str, study: Path) -> None:
    with httpx.Client(base_url=url) as browser:
        assert browser.post("/admin/login", data={"secret": "wrong"}).status_code == 401
        response = browser.post("/admin/login", data={"secret": admin_secret(study)})
        assert response.status_code == 303
        cookie = response.headers["set-cookie"].lower()
        assert "httponly" in cookie
        assert "samesite=strict" in cookie
        assert browser.get("/admin").status_code == 200
        ((name, value),) = browser.cookies.items()
    until, signed = value.split(".")
    for forged in (f"{int(until) + 1}.{signed}", f"{until}.{signed[:-1]}", "x.y", "."):
        assert httpx.get(f"{url}/admin", headers={"Cookie": f"{name}={forged}"}).status_code == 401


def test_logging_out_and_in_is_by_post_from_our_own_pages(url: str, study: Path) -> None:
    secret = admin_secret(study)
    with httpx.Client(base_url=url) as browser:
        browser.post("/admin/login", data={"secret": secret})
        for path in ("logout", "login", "gate"):  # as by Enter in the address bar: to the page, and nothing happens
            reply = browser.get(f"/admin/{path}")
            assert (reply.status_code, reply.headers["location"]) == (303, "/admin")
        assert browser.get("/admin").status_code == 200
        foreign = {"Origin": "https://elsewhere.example"}
        for path, fields in (("logout", {}), ("login", {"secret": secret}), ("gate", {"state": "closed"})):
            assert browser.post(f"/admin/{path}", data=fields, headers=foreign).status_code == 403
        page = browser.get("/admin")
        assert page.status_code == 200 and page.headers["cache-control"] == "no-store"
        assert browser.post("/admin/logout").status_code == 303
        assert browser.get("/admin").status_code == 401


def test_guessing_is_told_to_stop_and_locks_nobody_out(url: str, study: Path) -> None:
    statuses = [httpx.post(f"{url}/admin/login", data={"secret": "x"}).status_code for _ in range(GUESSES + 1)]
    assert statuses == [401] * GUESSES + [429]
    bearer = {"Authorization": "Bearer wrong"}
    assert httpx.get(f"{url}/admin", headers=bearer).status_code == 429
    assert httpx.get(f"{url}/admin").status_code == 401  # the form to log in by
    assert httpx.post(f"{url}/admin/login", data={"secret": admin_secret(study)}).status_code == 303
    bearer = {"Authorization": f"Bearer {admin_secret(study)}"}
    assert httpx.get(f"{url}/admin", headers=bearer).status_code == 200


def test_a_secret_that_could_be_guessed_is_refused(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_ADMIN_SECRET", "secret")
    with pytest.raises(BadInput, match="FAKESSS_ADMIN_SECRET: has 6 characters; give at least 16"):
        create_app(study)
    with pytest.raises(BadInput, match="FAKESSS_ADMIN_SECRET"):
        admin_secret(study)


def test_the_environment_may_set_the_secret(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_ADMIN_SECRET", "from the environment")
    with served(study) as url:
        headers = {**JSON, "Authorization": "Bearer from the environment"}
        assert httpx.get(f"{url}/admin", headers=headers).status_code == 200


def test_page_and_export_count_alike(admin: httpx.Client, url: str, exported: Exported) -> None:
    Participant(url).to_trials().to_end()
    Participant(url).to_trials().rate()
    Participant(url).consent()
    Participant(url)
    page = admin.get("/admin").json()
    people = exported("participants")
    assert page["started"] == len(people) == 3
    for state in ("finished", "active", "dropped", "withdrawn"):
        assert page[state] == sum(person["status"] == state for person in people)
    assert page["finished"] == 1
    assert page["ratings"] == page["recent_ratings"] == sum(row["rating"] != "" for row in exported()) == 8
    assert [row["people"] for row in page["rows"]] == [1, 1, 1, 0, 0, 0]
    assert len(page["dropped_at"]) == 3


def test_no_ratings_no_report(study: Path) -> None:
    calls = []
    with served(study, make_report=lambda: calls.append(1) or study) as url:  # type: ignore[func-returns-value]
        headers = {**JSON, "Authorization": f"Bearer {admin_secret(study)}"}
        assert "no ratings yet" in httpx.get(f"{url}/admin/report/", headers=headers).json()["error"]
    assert not calls


@pytest.mark.parametrize(("path", "kind"), [("", "text/html"), ("results.json", "application/json")])
def test_no_report_is_no_success(study: Path, path: str, kind: str) -> None:
    """A program that fetches results.json must not take the apology for results."""
    with served(study, make_report=lambda: study) as url:
        headers = {"Accept": "*/*", "Authorization": f"Bearer {admin_secret(study)}"}
        response = httpx.get(f"{url}/admin/report/{path}", headers=headers)
    assert response.status_code == 409 and response.headers["content-type"].startswith(kind)
    assert "There are no ratings yet" in response.text


def test_the_report_is_written_anew_and_nothing_else_is_served(study: Path) -> None:
    folder = study / "report"
    written = []

    def make_report() -> Path:
        (folder / "figures").mkdir(parents=True, exist_ok=True)
        (folder / "figures" / "a.svg").write_text("<svg/>")
        written.append(1)
        (folder / "index.html").write_text(f"<p>report {len(written)}")
        return folder

    with served(study, make_report=make_report) as url:
        Participant(url).to_trials().rate()
        headers = {"Authorization": f"Bearer {admin_secret(study)}"}
        with httpx.Client(base_url=url, headers=headers, follow_redirects=True) as client:
            assert client.get("/admin/report").text == "<p>report 1"
            assert client.get("/admin/report/").text == "<p>report 2"
            assert client.get("/admin/report/figures/a.svg").headers["content-type"].startswith("image/svg")
            assert len(written) == 2
            for path in (
                "..%2fstudy.toml",
                "..%2fratings.sqlite",
                "%2fetc%2fpasswd",
                "figures",
                "none.html",
                "a%00b",
                "x" * 5000,
            ):
                assert client.get(f"/admin/report/{path}").status_code == 404


def test_a_report_that_cannot_be_made_says_why(study: Path) -> None:
    def make_report() -> Path:
        raise BadInput("ratings: too few people")

    with served(study, make_report=make_report) as url:
        Participant(url).to_trials().rate()
        headers = {**JSON, "Authorization": f"Bearer {admin_secret(study)}"}
        assert httpx.get(f"{url}/admin/report/", headers=headers).json()["error"] == "ratings: too few people"


def test_two_servers_on_one_host_leave_each_others_researcher_in(study: Path, url: str) -> None:
    """A pilot beside the study, on another port: browsers send cookies of a host to all its ports."""
    with served(study, mode="pilot") as pilot, httpx.Client() as browser:
        for address in (url, pilot):
            assert browser.post(f"{address}/admin/login", data={"secret": admin_secret(study)}).status_code == 303
        assert [browser.get(f"{address}/admin").status_code for address in (url, pilot)] == [200, 200]
        browser.post(f"{pilot}/admin/logout")
        assert [browser.get(f"{address}/admin").status_code for address in (url, pilot)] == [200, 401]


def test_the_door_says_where_the_secret_is(url: str) -> None:
    page = httpx.get(f"{url}/admin").text
    assert "prints it when it starts, unless it was given by <code>FAKESSS_ADMIN_SECRET</code>" in page
