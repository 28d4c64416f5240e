"""What others' participants lived through on the last page, in foreign frames and while the server was replaced."""

import contextlib
import functools
import http.server
import os
import shutil
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from faulty_network import FaultyNetwork, faulty_network
from playwright.sync_api import Browser, BrowserContext, Error, Frame, Page, expect
from server_process import ROOT, server_process
from steps import rate
from trial_pages import begun, short_study
from whole_sessions import all_is_stored, answer, answered, due, keys_of, session_now, to_code

from study_server.serve import served

pytestmark = pytest.mark.browser

MOMENTS = {
    "after the last key": "trials",
    "answer on its way": "trials",
    "answer lost": "trials",
    "answer stored, browser not told": "comments",
    "at the comments": "comments",
    "comment on its way": "comments",
    "comment stored, browser not told": "done",
    "at the code": "done",
}
"""When the browser dies, and the step that the session then has on the server."""
MANNERS = ("tab closed", "window closed, its storage gone", "tab's process killed")
KILLS = [
    (moment, manner) if number % 3 == other % 3 else pytest.param(moment, manner, marks=pytest.mark.long)
    for number, moment in enumerate(MOMENTS)
    for other, manner in enumerate(MANNERS)
]


@pytest.mark.parametrize(("moment", "manner"), KILLS)
def test_killed_on_the_last_page(launch: Callable[..., Browser], tmp_path: Path, moment: str, manner: str) -> None:
    """jsPsych#2050, reVISit#1182, ibex#20: people with a code and no data, or with data and no code."""
    study = short_study(tmp_path, 2)
    browser = launch()
    with served(study) as url, faulty_network(url) as network:
        context = browser.new_context()
        page = context.new_page()
        address = network.url + begun(url).removeprefix(url)
        page.goto(address)
        answer(page, 1)
        due(page, 2)
        to_the_moment(page, network, study, moment)
        assert session_now(study)[1] == MOMENTS[moment]
        kill(browser, page, manner)
        session_now(study)  # is judged
        network.heal()
        if manner.startswith("window"):
            context = browser.new_context()
        page = context.new_page()
        page.goto(address)
        code = to_code_from_anywhere(page)
        page.reload()
        assert page.locator("#code").inner_text() == code
        elsewhere = browser.new_context().new_page()
        elsewhere.goto(address)
        assert elsewhere.locator("#code").inner_text() == code
    browser.close()
    all_is_stored(study, code, 2)


def to_the_moment(page: Page, network: FaultyNetwork, study: Path, moment: str) -> None:
    """From the last trial to where the browser dies."""
    if moment == "answer lost":
        network.cut()
    elif moment == "answer on its way":
        network.latency(request=1.5, where="POST ")
    elif moment == "answer stored, browser not told":
        network.latency(response=5, where="POST ")
    if moment == "after the last key":
        for key in keys_of(2):
            page.keyboard.press(key)
        return
    rate(page, keys_of(2))
    if moment == "answer on its way":
        network.wait_for_request("POST .*/ratings", 2)
    elif moment == "answer stored, browser not told":
        until_step(study, "comments")
    if not moment.startswith("answer"):
        past_the_comments(page, network, study, moment)


def past_the_comments(page: Page, network: FaultyNetwork, study: Path, moment: str) -> None:
    """The same for the pages after the trials."""
    page.wait_for_selector("body.comments")
    if moment == "comment on its way":
        network.latency(request=1.5, where="POST ")
    elif moment == "comment stored, browser not told":
        network.latency(response=5, where="POST ")
    if moment == "at the comments":
        return
    page.locator("#comments").fill("None.")
    page.evaluate("setTimeout(() => document.querySelector('main button').click())")
    if moment == "comment on its way":
        network.wait_for_request("POST .*/comments")
    else:
        until_step(study, "done")
    if moment == "at the code":
        page.wait_for_selector("#code")


def until_step(study: Path, step: str) -> None:
    """Wait until the server is there."""
    deadline = time.monotonic() + 30
    while session_now(study)[1] != step:
        assert time.monotonic() < deadline
        time.sleep(0.02)


def kill(browser: Browser, page: Page, manner: str) -> None:
    """The end of this page, which is asked nothing."""
    if manner == "tab closed":
        page.close()
    elif manner.startswith("window"):
        page.context.close()
    else:
        processes = browser.new_browser_cdp_session().send("SystemInfo.getProcessInfo")["processInfo"]
        with page.expect_event("crash"):
            for process in processes:
                if process["type"] == "renderer":
                    os.kill(process["id"], signal.SIGKILL)
        page.close()


def to_code_from_anywhere(page: Page) -> str:
    """What somebody does who finds this page: answer what is asked, until there is a code."""
    deadline = time.monotonic() + 60
    while (step := page.locator("body").get_attribute("class")) != "done":
        assert time.monotonic() < deadline, step
        with contextlib.suppress(Error):  # the page is just going
            if step == "comments":
                page.locator("main button").first.press("Enter", timeout=1000)
            elif page.locator(".question input:enabled:not(:checked)").count() == 14:
                rate(page, keys_of(2))
        page.wait_for_timeout(50)
    return page.locator("#code").inner_text()


BLOCKED = {"profile": {"default_content_setting_values": {"cookies": 2}}}
BLOCKED_IN_FRAMES = {"profile": {"block_third_party_cookies": True, "cookie_controls_mode": 1}}


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[str]:
    """Another site, whose pages are in tmp_path/lab; for a browser localhost and 127.0.0.1 are strangers."""
    (tmp_path / "lab").mkdir()
    handler = functools.partial(Quiet, directory=tmp_path / "lab")
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://localhost:{server.server_port}"
        server.shutdown()
        thread.join()


class Quiet(http.server.SimpleHTTPRequestHandler):
    """Files, without a word."""

    def log_message(self, *_: object) -> None:
        """None."""


@pytest.mark.parametrize("where", ["cookies blocked", "in a frame", "in a frame, cookies blocked there"])
def test_session_without_cookies(
    launch_with: Callable[..., BrowserContext], tmp_path: Path, lab: str, where: str
) -> None:
    """formr#310: who blocked cookies, or met the study in another site's frame, began anew at each page.

    Private windows: each browser of these tests is one (Playwright's contexts are off the record).
    """
    study = short_study(tmp_path, 3, frame_ancestors=[lab])
    page = launch_with(
        BLOCKED if where == "cookies blocked" else BLOCKED_IN_FRAMES if "there" in where else {}
    ).new_page()
    with served(study) as url:
        (tmp_path / "lab" / "page.html").write_text(f'<iframe src="{url}" width="900" height="700"></iframe>')
        page.goto(url if where == "cookies blocked" else f"{lab}/page.html")
        frame = page.frames[-1]
        if "blocked" in where:
            with pytest.raises(Error, match="SecurityError"):
                frame.evaluate("localStorage.length")
        frame.locator(".agree button").click()
        frame.wait_for_selector("body.instructions")
        frame.locator("main button").click()
        for trial in range(1, 4):
            expect(frame.locator("#count")).to_have_text(f"{trial} of 3", timeout=30_000)
            assert "blocked" not in where or len(answered(study)) == trial - 1
            click_answers(frame, trial)
        frame.wait_for_selector("body.comments")
        frame.locator("main button").click()
        code = frame.locator("#code").inner_text()
    all_is_stored(study, code, 3)


def click_answers(frame: Frame, trial: int) -> None:
    """Answer by mouse."""
    for number, key in enumerate(keys_of(trial)):
        frame.locator(".question").nth(number).locator(f"label:has(input[value='{key}'])").click()
    frame.locator("#next").click()


def test_each_picture_is_fetched_once_in_a_whole_session(page: Page, tmp_path: Path) -> None:
    """jsPsych#1548: pictures were asked for again. Here neither practice and trials nor a reload ask twice."""
    study = short_study(tmp_path, 3, practice=2)
    with served(study) as url, faulty_network(url) as network:
        page.goto(network.url + begun(url, ready=False).removeprefix(url))
        for step, trials in (("practice", 2), ("trials", 3)):
            for trial in range(1, trials + 1):
                page.wait_for_selector(f"body.{step} #count:text('{trial} of')")
                expect(page.locator(".question input").first).to_be_enabled(timeout=30_000)
                page.reload()
                expect(page.locator(".question input").first).to_be_enabled(timeout=30_000)
                rate(page, keys_of(trial))
            if step == "practice":
                page.wait_for_selector("body.ready")
                page.locator("main button").press("Enter")
        to_code(page)
        pictures = [line for line in network.lines if line.startswith("GET /picture/")]
        assert len(pictures) == len(set(pictures)) == 3


@pytest.mark.parametrize("people", [4, pytest.param(30, marks=pytest.mark.long)])
def test_starters_at_once(browser: Browser, tmp_path: Path, people: int) -> None:
    """jsPsych#605, #1393, #1934: a class that began together waited for pictures that never came."""
    study = short_study(tmp_path, 6, size=400)
    with served(study) as url:
        contexts = [browser.new_context() for _ in range(people)]
        tabs = [context.new_page() for context in contexts]
        for tab in tabs:
            tab.goto(begun(url), wait_until="commit")
        for tab in tabs:
            due(tab, 1)
        for context in contexts:
            context.close()


def test_server_upgraded_under_an_open_page(page: Page, tmp_path: Path) -> None:
    """A page that is older than its server: it goes on with what it shows, and loads the new one with nothing lost."""
    study = short_study(tmp_path, 6)
    release = tmp_path / "release"
    shutil.copytree(ROOT / "study_server", release / "study_server")
    prefix = ["env", "-C", str(release), f"PYTHONPATH={release}"]
    with server_process(study, tmp_path / "log", prefix=prefix) as server:
        page.goto(begun(server.url))
        answer(page, 1)
        due(page, 2)
        server.stop()
        answer(page, 2)
        due(page, 3)
        page.keyboard.press("7")  # half an answer on the screen
        upgrade(release / "study_server")
        server.start()
        expect(page.locator("#saved")).to_have_text("Saved", timeout=60_000)
        expect(page.locator("input:checked")).to_have_count(1)
        assert page.locator("[data-new]").count() == 0
        page.locator("#question-0, input[name=question-0]").first.focus()
        rate(page, keys_of(3))
        page.wait_for_selector("[data-new]")
        for trial in (4, 5, 6):
            answer(page, trial)
        code = to_code(page)
        assert server.unforeseen() == []
    all_is_stored(study, code)


def upgrade(package: Path) -> None:
    """A release whose page, scripts and JSON go together, and not with those before."""
    (package / "static" / "outbox.js").rename(package / "static" / "kept.js")
    for name, old, new in (
        ("pages.py", '"ahead"', '"upcoming"'),
        ("static/survey.js", "/outbox.js", "/kept.js"),
        ("static/survey.js", ".ahead", ".upcoming"),
        ("static/leftover.js", "/outbox.js", "/kept.js"),
        ("templates/trials.html", '<form id="trial"', '<form id="trial" data-new="yes"'),
    ):
        text = (package / name).read_text(encoding="utf-8")
        assert old in text
        (package / name).write_text(text.replace(old, new), encoding="utf-8")
