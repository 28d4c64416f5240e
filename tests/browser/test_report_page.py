"""The report in a real browser: behind the admin's door, under its policy, at every width, sorted by mouse and keys."""

from collections.abc import Iterator
from functools import cache
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Locator, Page, expect
from study_fixture import write_study

from analysis import write_report
from analysis.pdf import write_pdf
from analysis.plan import AnalysisPlan
from analysis.script import script_source
from fakesss.cli_analysis import report_folder
from study_server.app import admin_secret
from study_server.manifest import load_study
from study_server.serve import served
from study_server.simulation.simulate import simulate

pytestmark = pytest.mark.browser

SECRET = "a secret of the tests"
HEADINGS = "[...document.querySelectorAll('h1,h2,h3,h4,h5,h6')].map(each => Number(each.tagName[1]))"
OVERFLOW = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
# WCAG 2.2: the contrast of every text with what is behind it, the least of all
CONTRAST = """() => {
  const parse = text => text.match(/[\\d.]+/g).map(Number);
  const light = ([r, g, b]) => [r, g, b].map(c => c / 255)
    .map(c => c <= .04045 ? c / 12.92 : ((c + .055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [.2126, .7152, .0722][i], 0);
  const behind = node => {
    for (; node; node = node.parentElement) {
      const colour = parse(getComputedStyle(node).backgroundColor);
      if (colour.length < 4 || colour[3] > 0) return colour;
    }
    return [255, 255, 255];
  };
  let least = 21;
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode.parentElement;
    if (!walker.currentNode.data.trim() || node.closest("svg, script, style") || !node.checkVisibility()) continue;
    const pair = [light(parse(getComputedStyle(node).color)), light(behind(node))].sort((a, b) => b - a);
    least = Math.min(least, (pair[0] + .05) / (pair[1] + .05));
  }
  return least;
}"""


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Path]]:
    """A study of three pictures that simulated raters have answered, served with its report."""
    patch = pytest.MonkeyPatch()
    patch.setenv("FAKESSS_ADMIN_SECRET", SECRET)
    study = write_study(tmp_path_factory.mktemp("answered") / "study", size=120)
    make_report = cache(lambda: report_folder(study, None, "simulated"))
    with served(study, mode="simulated", make_report=make_report, report_script=script_source()) as url:
        simulate(url, load_study(study), admin_secret(study), started=6, completed=6, progress=False)
        yield url, study
    patch.undo()


@pytest.fixture
def report(page: Page, answered: tuple[str, Path]) -> Page:
    """The report's page, after the admin's door; what the policy refuses fails the test."""
    url, _ = answered
    refused: list[str] = []
    page.on("console", lambda message: refused.append(message.text) if message.type == "error" else None)
    page.goto(f"{url}/admin")
    page.locator("input[name=secret]").fill(SECRET)
    with page.expect_navigation(url="**/admin"):
        page.keyboard.press("Enter")
    refused.clear()  # the door itself answers 401
    response = page.goto(f"{url}/admin/report/")
    assert response is not None and response.status == 200
    assert f"script-src {script_source()};" in response.headers["content-security-policy"]
    assert refused == []
    return page


def column(page: Page, table: str, number: int) -> list[str]:
    """The texts that are read in a column, from top to bottom."""
    return page.locator(f"#{table} tbody tr > :nth-child({number})").all_inner_texts()


def test_a_table_is_sorted_by_mouse_and_keyboard_and_goes_back(report: Page) -> None:
    heads = report.locator("#table-tests thead th")
    assert heads.get_by_role("button").count() == heads.count() > 4
    as_written = column(report, "table-tests", 1)
    assert len(as_written) == 2
    number = heads.all_inner_texts().index("F") + 1
    values = [float(text) for text in column(report, "table-tests", number)]
    button = heads.nth(number - 1).get_by_role("button")
    button.click()
    assert [float(text) for text in column(report, "table-tests", number)] == sorted(values)
    expect(heads.nth(number - 1)).to_have_attribute("aria-sort", "ascending")
    button.press("Enter")
    assert [float(text) for text in column(report, "table-tests", number)] == sorted(values, reverse=True)
    expect(heads.nth(number - 1)).to_have_attribute("aria-sort", "descending")
    button.press(" ")
    assert column(report, "table-tests", 1) == as_written
    assert report.locator("[aria-sort]").count() == 0


def test_a_sorted_row_still_says_to_which_group_it_belongs(report: Page) -> None:
    """A name that stands once above its rows is repeated as soon as they part."""
    table = next(each for each in report.locator("figure.table").all() if each.locator(".again").count())
    name = table.get_attribute("id") or ""
    assert "" in column(report, name, 1)
    table.locator("thead button").nth(2).click()
    assert "" not in column(report, name, 1)


@pytest.mark.parametrize("width", [1280, 640, 390])
def test_no_width_makes_the_page_scroll_sideways(report: Page, width: int) -> None:
    """1280, the same at 200 % zoom, a phone: what is wider scrolls in a box of its own, which the keyboard reaches."""
    report.set_viewport_size({"width": width, "height": 800})
    assert report.evaluate(OVERFLOW) == 0
    assert report.locator(".scroll:not([tabindex='0'])").count() == 0


@pytest.fixture(scope="module")
def standing_out(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The address of a report whose widest table has as much to say as it can: who stands out, by the survey's ids."""
    folder = tmp_path_factory.mktemp("standing_out")
    lines = ["participant,stimulus,question,rating,trial,rt_ms"]
    for who in range(9):
        for what in range(30 if who else 12):
            answer = 1 + (what + who * what) % 3 if who else 7 - what % 3
            lines.append(f"3a8c15362971e81{who},i{what},shiny,{answer},{what},{150 if who == 0 else 2000}")
    (folder / "ratings.csv").write_text("\n".join(lines))
    plan = AnalysisPlan.model_validate({"completers_only": False, "tests": []})
    write_report(folder / "ratings.csv", folder / "out", plan=plan)
    return (folder / "out" / "index.html").as_uri()


def test_a_cut_table_shows_that_it_goes_on(page: Page, standing_out: str) -> None:
    """On a screen none is cut; on a phone the edge behind which there is more is shaded, and the end is not."""
    page.set_viewport_size({"width": 1280, "height": 800})
    page.goto(standing_out)
    assert "answers missing" in column(page, "table-quality", 2)[0]
    cut = "each => each.scrollWidth - each.clientWidth"
    assert [each.evaluate(cut) for each in page.locator(".table .scroll").all() if each.is_visible()].count(0) > 2
    assert all(each.evaluate(cut) <= 0 for each in page.locator(".table .scroll").all())
    page.set_viewport_size({"width": 390, "height": 800})
    box = page.locator("#table-quality .scroll")
    assert box.evaluate(cut) > 50
    assert shade(box, right=True) < 230 and shade(box, right=False) == 255
    box.evaluate("each => each.scrollTo(9999, 0)")
    assert shade(box, right=True) == 255 and shade(box, right=False) < 230


def shade(box: Locator, *, right: bool) -> int:
    """The grey of most of the outermost column of pixels but one, 0..255."""
    with Image.open(BytesIO(box.screenshot())) as shot:
        grey = np.asarray(shot.convert("L"))
    return int(np.median(grey[:, -2 if right else 1]))


def test_a_page_for_everyone(report: Page) -> None:
    """Landmarks, headings without gaps, names of what is no text, heads that say what they head, contrast."""
    levels = report.evaluate(HEADINGS)
    assert levels[0] == 1 and levels.count(1) == 1
    assert all(after - before <= 1 for before, after in pairwise(levels))
    assert [report.locator(each).count() for each in ("header", "nav[aria-label]", "main")] == [1, 1, 1]
    assert report.locator("th:not([scope])").count() == 0
    assert (
        report.locator(
            "figure.table:not(:has(figcaption)), img:not([alt]), svg[role=img]:not([aria-labelledby])"
        ).count()
        == 0
    )
    assert report.evaluate("document.documentElement.lang") == "en"
    assert report.evaluate(CONTRAST) >= 4.5


def test_every_figure_shows_its_pictures(report: Page) -> None:
    """Thumbnails are kept once, and each figure draws them from there: none is empty."""
    sizes = report.evaluate("[...document.querySelectorAll('figure.plot use[href], figure.plot use')].filter("
                            "each => (each.getAttribute('xlink:href') || '').includes('picture-'))"
                            ".map(each => each.getBoundingClientRect().width)")  # fmt: skip
    assert len(sizes) >= 6 and min(sizes) > 10


def test_the_page_is_complete_without_its_script(browser: Browser, report: Page, answered: tuple[str, Path]) -> None:
    plain = browser.new_context(java_script_enabled=False).new_page()
    plain.goto((answered[1] / "report" / "simulated" / "index.html").as_uri())
    for selector in ("figure.table tbody tr", "figure.plot svg", "section > h2"):
        assert plain.locator(selector).count() == report.locator(selector).count() > 0
    assert plain.get_by_role("button").count() == 0
    plain.context.close()


def test_a_folded_table_is_printed(report: Page, answered: tuple[str, Path], tmp_path: Path) -> None:
    """On paper nothing can be opened. Pages are counted: a hundred rows more are two pages and more."""
    source = (answered[1] / "report" / "simulated" / "index.html").read_text(encoding="utf-8")
    rows = "".join(f"<tr><td>{number}</td></tr>" for number in range(150))
    folded = f"<main><details><summary>150 rows</summary><table><tbody>{rows}</tbody></table></details>"
    assert source.count("<main>") == 1
    pages = []
    for name, text in (("as-it-is", source), ("longer", source.replace("<main>", folded))):
        (tmp_path / f"{name}.html").write_text(text, encoding="utf-8")
        pages.append(
            write_pdf(tmp_path / f"{name}.html", tmp_path / f"{name}.pdf").read_bytes().count(b"/Type /Page\n")
        )
    assert pages[0] >= 3 and pages[1] >= pages[0] + 2
