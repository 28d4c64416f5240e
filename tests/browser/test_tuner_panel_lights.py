"""Lights and colours on the tuner's panel."""

import re

import numpy as np
import pytest
from accessible import cut_off
from playwright.sync_api import expect
from tuner_panel import BASE, Panel

from fakesss.colour import decode_srgb, encode_srgb

pytestmark = [pytest.mark.browser, pytest.mark.gl]


def test_srgb_and_linear_light_are_those_of_the_renderer(panel: Panel) -> None:
    both = panel.page.evaluate(
        """async (lights) => {
      const { decodeSrgb, encodeSrgb, fromHex, toHex } = await import(new URL("static/colour.js", location.href));
      const codes = [...Array(256).keys()];
      const hex = codes.map((code) => `#${code.toString(16).padStart(2, "0").repeat(3)}`);
      return {
        decoded: codes.map((code) => decodeSrgb(code / 255)),
        encoded: lights.map(encodeSrgb),
        isBack: hex.every((each) => toHex(fromHex(each)) === each),
        bright: toHex([4, 2, 0]),
        back: fromHex("#ff0000", 4),
      };
    }""",
        lights := np.linspace(-0.5, 1.5, 101).tolist(),
    )
    np.testing.assert_allclose(both["decoded"], decode_srgb(np.arange(256) / 255), rtol=1e-12)
    np.testing.assert_allclose(both["encoded"], encode_srgb(np.array(lights)), rtol=1e-12)
    assert both["isBack"]
    assert both["bright"] == "#ffbc00"  # half as much light is code 188
    assert both["back"] == [4, 0, 0]


def test_a_swatch_sets_linear_light_and_follows_the_sliders(panel: Panel) -> None:
    panel.tab("material")
    swatch = panel.control("material.diffuse").locator("input[type=color]")
    numbers = panel.control("material.diffuse").locator("input.typed")
    swatch.fill("#bc0000")
    expect(numbers.first).to_have_value("0.50289")
    panel.wait_for_changes({"material.diffuse": [0.50289, 0, 0]})
    numbers.nth(1).fill("1")
    numbers.nth(1).press("Enter")
    expect(swatch).to_have_value("#bcff00")
    panel.tab("lights")
    bright = panel.control("light.diffuse")
    bright.locator("input.typed").first.fill("4")
    bright.locator("input.typed").first.press("Enter")
    bright.locator("input[type=color]").fill("#00ff00")
    panel.wait_for(lambda: panel.changes.get("light.diffuse") == [0, 4, 0])  # as bright as it was


def test_lights_are_added_picked_tuned_and_removed(panel: Panel) -> None:
    page = panel.page
    panel.tab("lights")
    add, remove = page.get_by_role("button", name="Add light"), page.get_by_role("button", name="Remove", exact=True)
    expect(remove).to_be_disabled()
    panel.type("light.elevation", "7")
    panel.type("light.azimuth", "170.33")
    add.click()
    expect(panel.typed("light.elevation")).to_have_value("7")  # a copy of the main light as it is now
    expect(panel.typed("light.azimuth")).to_have_value("-129.67")
    panel.wait_for(lambda: panel.changes["lights"][0]["azimuth"] == -129.67)  # what is shown is what is set
    panel.page.get_by_role("radio", name="Main light").check(force=True)
    for name in ("elevation", "azimuth"):
        panel.control(f"light.{name}").get_by_role("button", name=f"Reset {name}").click()
    page.get_by_role("radio", name="Light 2").check(force=True)
    expect(page.get_by_role("radio", name="Light 2")).to_be_checked()
    expect(panel.control("light.cutoff").locator(".otherwise")).to_have_text("only of a spot light")
    expect(panel.slider("light.cutoff")).to_be_hidden()
    expect(panel.control("light.kind").locator(".reset")).to_be_hidden()
    expect(panel.control("light.ambient").locator(".reset")).to_be_visible()  # a further light adds none
    panel.control("light.kind").locator("select").select_option("spot")
    panel.type("light.cutoff", "12")
    panel.wait_for(lambda: panel.changes.get("lights", [{}])[0].get("cutoff") == 12)
    assert panel.changes["lights"][0]["kind"] == "spot"
    assert panel.changes["lights"][0]["ambient"] == [0, 0, 0]
    assert set(panel.changes) == {"lights"}
    expect(panel.slider("light.cutoff")).to_have_accessible_description(re.compile(r"Scene field lights\.0\.cutoff\."))
    page.get_by_role("radio", name="Main light").check(force=True)
    expect(panel.control("light.kind").locator("select")).to_have_value('"directional"')
    expect(remove).to_be_disabled()
    page.get_by_role("radio", name="Light 2").check(force=True)
    expect(panel.typed("light.cutoff")).to_have_value("12")
    panel.control("light.cutoff").get_by_role("button", name="Reset cut-off").click()
    expect(panel.typed("light.cutoff")).to_have_value("20")
    remove.click()
    panel.wait_for_changes({})
    expect(page.get_by_role("radio", name="Main light")).to_be_focused()
    page.locator("#undo").click()
    expect(page.get_by_role("radio", name="Light 2")).to_be_visible()


REMOVED = """async () => {
  const { Settings } = await import(new URL("static/settings.js", location.href));
  const lights = [10, 40, 99].map((azimuth) => ({ azimuth }));
  const settings = new Settings({ base: { lights, quality: "" }, qualities: {} });
  const seen = [];
  const see = () => seen.push([settings.value("lights").length, settings.original("lights.0.azimuth") ?? null,
    settings.isChanged("lights.0.azimuth")]);
  settings.removeLight(0);
  see();
  settings.set("lights.0.azimuth", 7);
  see();
  settings.reset("lights.0.azimuth");
  see();
  settings.removeLight(0);
  see();
  settings.set("lights", [...settings.value("lights"), { azimuth: 1 }, { azimuth: 2 }]);
  see();
  seen.push(settings.original("lights.1.azimuth") === undefined);
  settings.undo();
  settings.undo();
  see();
  settings.reset();
  settings.set("lights", [...settings.value("lights"), { azimuth: 1 }]);
  see();
  settings.replace({ changes: { lights: [{ azimuth: 99 }] }, effects: {} });
  see();
  return seen;
}"""


def test_a_light_is_compared_with_itself_though_one_before_it_is_gone(panel: Panel) -> None:
    assert panel.page.evaluate(REMOVED) == [
        [2, 40, False],
        [2, 40, True],
        [2, 40, False],
        [1, 99, False],
        [3, 99, False],
        True,
        [2, 40, False],
        [4, 10, False],
        [1, None, True],  # of a link: nobody knows which it is
    ]


def test_no_more_lights_than_a_scene_has(panel: Panel) -> None:
    panel.tab("lights")
    light = BASE.light.model_dump(mode="json")
    settings = {"changes": {"lights": [light] * 30}, "effects": {}}
    panel.page.evaluate(
        "settings => { location.hash = `#s=${encodeURIComponent(JSON.stringify(settings))}` }", settings
    )
    add = panel.page.get_by_role("button", name="Add light")
    expect(panel.page.get_by_role("radio", name="Light 31")).to_be_visible()
    add.click()
    expect(add).to_be_disabled()
    expect(panel.page.get_by_role("radio", name="Light 32")).to_be_checked()
    assert cut_off(panel.page, 390) == []
