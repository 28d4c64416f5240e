"""What is measured of a page for people who read, hear or operate it in another way than its author."""

from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import BrowserContext, Page

AXE = Path(__file__).parents[2] / "node_modules" / "axe-core" / "axe.min.js"
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]

RUN_AXE = """tags => axe.run({ runOnly: tags, rules: { "target-size": { enabled: true } } }).then(({ violations }) =>
  violations.map(({ id, help, nodes }) => `${id}: ${help}: ${nodes.map(({ html }) => html).join(" ")}`))"""

CUT_OFF = """async () => {
  for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
  const wide = document.scrollingElement.scrollWidth;
  const found = wide > innerWidth ? [`the page is ${wide} wide in a window of ${innerWidth}`] : [];
  for (const element of document.querySelectorAll("body *")) {
    const { left, right, width, height } = element.getBoundingClientRect();
    if (!element.checkVisibility() || width <= 1 || element.closest(".scroll")) continue;
    const clips = getComputedStyle(element).overflowX !== "visible" && element.scrollWidth > element.clientWidth + 1;
    const name = `${element.tagName} ${element.textContent.trim().slice(0, 40)}`;
    if (left < -1 || right > innerWidth + 1) found.push(`${name}: from ${left} to ${right} of ${innerWidth}`);
    const isTarget = element.matches("button, label:has(input)");
    if (isTarget && Math.min(width, height) < 24) found.push(`${name}: ${width} x ${height}`);
    if (clips) found.push(`${name}: ${element.scrollWidth} wide in ${element.clientWidth}`);
  }
  return found;
}"""
"""What does not fit the window's width, once it is drawn anew; tables may scroll in themselves (WCAG 1.4.10).

Labels are as large as what can be hit (2.5.8); axe measures the unseen buttons inside them."""

SPACED = """() => {
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(`* { line-height: 1.5 !important; letter-spacing: .12em !important; word-spacing: .16em !important }
    p { margin-bottom: 2em !important }`);
  document.adoptedStyleSheets = [sheet];
}"""
"""What a reader may set, by WCAG 1.4.12."""

RING = """() => {
  const element = document.activeElement;
  if (element === document.body) return null;
  const ringed = element.matches(".scale input") ? element.nextElementSibling : element;
  const { outlineStyle, outlineWidth } = getComputedStyle(ringed);
  const { top, bottom, left, right } = ringed.getBoundingClientRect();
  const isInWindow = bottom > 0 && top < innerHeight && right > 0 && left < innerWidth;
  return {
    what: element.id || element.name || element.textContent.trim(),
    isSeen: isInWindow && outlineStyle !== "none" && parseFloat(outlineWidth) >= 2,
  };
}"""
"""What has the focus, and whether that can be seen."""


def with_axe(context: BrowserContext) -> BrowserContext:
    """Every page of it will have axe."""
    if not AXE.exists():
        pytest.fail("axe-core is not there: run `make node_modules/.ready`")
    context.add_init_script(path=AXE)
    return context


def violations(page: Page) -> list[str]:
    """What axe finds wrong by WCAG 2.2 A and AA, 24-pixel targets included, and by its own best practice."""
    found: list[str] = page.evaluate(RUN_AXE, TAGS)
    return found


def cut_off(page: Page, width: int, height: int = 800) -> list[str]:
    """What does not fit a window of this size, in CSS pixels, as it is and with the reader's own text spacing."""
    before: Any = page.viewport_size
    page.set_viewport_size({"width": width, "height": height})
    found: list[str] = page.evaluate(CUT_OFF)
    page.evaluate(SPACED)
    found += [f"with wider spacing: {each}" for each in page.evaluate(CUT_OFF)]
    page.evaluate("() => { document.adoptedStyleSheets = [] }")
    page.set_viewport_size(before)
    return found


def tab(page: Page) -> str:
    """Press Tab; what has the focus now, by its id, name or words. Fails if that cannot be seen."""
    page.keyboard.press("Tab")
    focus = page.evaluate(RING)
    if focus is None:
        return ""
    assert focus["isSeen"], f"the focus is on {focus['what']}, and is not to be seen"
    return str(focus["what"])


def tab_to(page: Page, what: str) -> None:
    """Press Tab until `what` has the focus: in the page's order, past everything before it."""
    passed = []
    while (focus := tab(page)) != what:
        passed.append(focus)
        assert len(passed) < 30, f"Tab does not lead to {what}, but to {passed}"
