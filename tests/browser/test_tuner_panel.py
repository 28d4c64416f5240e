"""The tuner's panel in a real browser, as a whole: what it shows, says and refuses; every tab, for everybody."""

import numpy as np
import pytest
from accessible import cut_off, violations
from playwright.sync_api import expect
from tuner_panel import BASE, Panel

from fakesss.tuner.page import PANELS
from fakesss.tuner.panel import GROUPS

pytestmark = [pytest.mark.browser, pytest.mark.gl]


def test_every_number_choice_and_switch_shows_the_scene_it_started_with(panel: Panel) -> None:
    for name, groups in GROUPS.items():
        panel.tab(name)
        for control in (control for group in groups for control in group.controls):
            value, row = BASE.at(control.path), panel.control(control.path)
            if control.kind == "switch":
                assert row.locator("input").is_checked() == value
            elif control.kind == "choice":
                assert row.locator("select").evaluate("select => JSON.parse(select.value)") == value
            elif value is not None:
                shown = [float(each.input_value()) for each in row.locator("input.typed").all()]
                assert shown == pytest.approx(np.ravel(value).tolist(), rel=1e-3)


def test_what_the_server_refuses_is_said_beside_the_field_until_it_is_mended(panel: Panel) -> None:
    panel.tab("lights")
    panel.control("light.kind").locator("select").select_option("point")
    attenuation = panel.control("light.attenuation")
    attenuation.locator("input.typed").first.fill("0")
    attenuation.locator("input.typed").first.press("Enter")
    expect(attenuation.locator(".problem")).to_contain_text("divides by zero")
    attenuation.locator("input.typed").last.fill("1")
    attenuation.locator("input.typed").last.press("Enter")
    expect(attenuation.locator(".problem")).to_be_hidden()
    panel.tab("camera")
    problem = panel.control("camera.near").locator(".problem")
    panel.type("camera.near", "5")
    panel.type("camera.far", "4")
    expect(problem).to_have_text("camera: near 5.0 must be < far 4.0")
    assert cut_off(panel.page, 320) == []
    panel.type("camera.far", "6")
    expect(problem).to_be_hidden()


def test_the_hint_says_what_a_screen_reader_says(panel: Panel) -> None:
    panel.tab("material")
    slider = panel.slider("material.backlight")
    slider.focus()
    expect(panel.page.locator("#hint")).to_contain_text("backlight contribution [wb], no unit. Equation 3.10.")
    expect(slider).to_have_accessible_description(
        "backlight contribution [wb], no unit. Equation 3.10. Scene field material.backlight."
    )
    panel.control("material.shininess").locator(".label").hover()
    expect(panel.page.locator("#hint")).to_contain_text("Blinn-Phong exponent [n]")


def test_tabs_by_keyboard(panel: Panel) -> None:
    page = panel.page
    page.locator("#tab-lights").focus()
    for key, tab in (("ArrowRight", "material"), ("End", "sweep"), ("ArrowRight", "lights"), ("ArrowLeft", "sweep")):
        page.keyboard.press(key)
        expect(page.locator(f"#tab-{tab}")).to_be_focused()
        expect(page.locator(f"#panel-{tab}")).to_be_visible()
        expect(page.locator("[role=tabpanel]:visible")).to_have_count(1)


def test_every_panel_is_sound_for_everybody(panel: Panel) -> None:
    panel.tab("lights")
    panel.control("light.kind").locator("select").select_option("spot")
    for name in PANELS:
        panel.tab(name)
        assert violations(panel.page) == [], name
        assert cut_off(panel.page, 320) == [], name


def test_each_group_of_the_table_is_on_the_page(panel: Panel) -> None:
    for name, groups in GROUPS.items():
        panel.tab(name)
        for group in groups:
            expect(panel.page.get_by_role("heading", name=group.title, exact=True)).to_be_visible()
