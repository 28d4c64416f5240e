"""The printed report, by a real Chromium."""

import re
import sys
import time
from pathlib import Path

import pytest

from analysis.pdf import for_paper, write_pdf
from fakesss.browser import VARIABLE, find_browser
from fakesss.problem import BadInput

PAGE = """<!doctype html><html><head><title>Glow &amp; haze</title>
<style>@media print { details::details-content { content-visibility: visible; } } h2 { break-before: page; }</style>
</head><body><h1>Glow &amp; haze</h1><h2>One</h2><p><a href="results.json">numbers</a> <a href="#two">two</a></p>
<h2 id="two">Two</h2></body></html>"""


@pytest.fixture
def page(tmp_path: Path) -> Path:
    path = tmp_path / "index.html"
    path.write_text(PAGE, encoding="utf-8")
    return path


@pytest.mark.browser
def test_pages_title_and_equal_bytes(page: Path, tmp_path: Path) -> None:
    """Nothing of the clock or of this machine's paths is in it."""
    data = write_pdf(page, tmp_path / "report.pdf").read_bytes()
    assert len(re.findall(rb"/Type ?/Page\b", data)) == 3
    assert b"/Title (Glow & haze)" in data
    assert b"file:" not in data and str(time.localtime().tm_year).encode() not in b"".join(re.findall(rb"\(D:.*", data))
    time.sleep(1.1)  # a PDF's dates are in seconds
    assert write_pdf(page, tmp_path / "again.pdf").read_bytes() == data


def test_links_inside_the_page_are_kept() -> None:
    assert '<a>numbers</a> <a href="#two">' in for_paper(PAGE) and "size: A4" in for_paper(PAGE)


def test_without_a_browser(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(
        BadInput, match=r"no Chromium or Chrome is on the PATH; apt-get install chromium, or set FAKESSS_CHROMIUM"
    ):
        find_browser()


def test_a_browser_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, sys.executable)
    assert find_browser() == sys.executable
    monkeypatch.setenv(VARIABLE, "no-such-browser")
    with pytest.raises(BadInput, match="FAKESSS_CHROMIUM: no-such-browser is no program"):
        find_browser()


def program(folder: Path, script: str) -> str:
    """A stand-in for a browser that fails in a way of its own."""
    path = folder / "browser"
    path.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    path.chmod(0o755)
    return str(path)


def test_a_browser_that_prints_nothing(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, program(tmp_path, "echo no fonts >&2; exit 3"))
    with pytest.raises(BadInput, match=r"printed no PDF \(exit code 3: no fonts\); set FAKESSS_CHROMIUM"):
        write_pdf(page, tmp_path / "report.pdf")


def test_a_browser_that_never_ends(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is ended with the processes it started, after the time allowed."""
    left = tmp_path / "left"
    monkeypatch.setenv(VARIABLE, program(tmp_path, f"(sleep 2; touch {left}) & wait; sleep 60"))
    began = time.monotonic()
    with pytest.raises(BadInput, match=r"took more than 0.3 s to print"):
        write_pdf(page, tmp_path / "report.pdf", timeout_s=0.3)
    assert time.monotonic() - began < 5
    time.sleep(2.2)
    assert not left.exists()


@pytest.mark.browser
def test_a_folder_that_is_not_there(page: Path, tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="cannot write the PDF"):
        write_pdf(page, tmp_path / "none" / "report.pdf")
