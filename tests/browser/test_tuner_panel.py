"""The tuner's panel in a real browser: every control by mouse, keyboard and typing."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh
from accessible import cut_off, violations, with_axe
from playwright.sync_api import Browser, Page, expect
from tuner_panel import Panel
from tuner_server import tuned

from fakesss.camera import View
from fakesss.colour import decode_srgb, encode_srgb
from fakesss.media import MEDIA
from fakesss.offline.fit_start import starting_scene
from fakesss.scene import Scene, scene_paths
from fakesss.shadow_maps import atlas
from fakesss.tuner.page import PANELS
from fakesss.tuner.panel import GROUPS

pytestmark = [pytest.mark.browser, pytest.mark.gl]

BASE = Scene.from_dict(
    {"object": "sphere:1000", "size": [64, 64], "supersampling": 1, "occlusion": {"rays": 4}}, "test"
)


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with tuned(BASE, tmp_path_factory.mktemp("tuned")) as address:
        yield address


@pytest.fixture(scope="module")
def opened(browser: Browser, url: str) -> Iterator[Panel]:
    with with_axe(browser.new_context(viewport={"width": 1280, "height": 800})) as context:
        context.set_default_timeout(15_000)
        page = context.new_page()
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        yield Panel(page, url)
        assert errors == []


@pytest.fixture
def panel(opened: Panel) -> Iterator[Panel]:
    """One tab for all tests, with the settings that it started with."""
    yield opened
    opened.reset()


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


def test_keys_step_a_slider_and_a_held_key_is_one_step_of_undo(panel: Panel) -> None:
    panel.tab("material")
    slider, number = panel.slider("material.backlight"), panel.typed("material.backlight")
    slider.focus()
    slider.press("ArrowRight")
    expect(number).to_have_value("1.25")
    slider.press("Shift+ArrowRight")
    expect(number).to_have_value("1.75")
    expect(slider).to_have_attribute("aria-valuetext", "1.75")
    for _ in range(3):
        panel.page.keyboard.down("ArrowLeft")  # repeats, as a held key does
    panel.page.keyboard.up("ArrowLeft")
    expect(number).to_have_value("1.6")
    panel.wait_for_changes({"material.backlight": 1.6})
    panel.page.locator("#undo").click()
    expect(number).to_have_value("1.75")
    slider.press("End")
    expect(number).to_have_value("3")
    slider.press("ArrowRight")
    expect(number).to_have_value("3")
    slider.press("Home")
    expect(number).to_have_value("0")


def test_keys_step_a_logarithmic_slider_and_whole_numbers(panel: Panel) -> None:
    panel.tab("material")
    panel.slider("material.shininess").press("ArrowUp")
    expect(panel.typed("material.shininess")).to_have_value("107")
    panel.slider("material.shininess").press("PageDown")
    expect(panel.typed("material.shininess")).to_have_value("53.6")
    panel.tab("shader")
    panel.slider("occlusion.rays").press("ArrowUp")
    expect(panel.typed("occlusion.rays")).to_have_value("17")


def test_a_drag_is_one_step_of_undo_and_moves_the_picture_meanwhile(panel: Panel) -> None:
    panel.tab("material")
    box = panel.slider("material.diffuse_weight").bounding_box()
    assert box is not None
    mouse, middle = panel.page.mouse, box["y"] + box["height"] / 2
    mouse.move(box["x"] + 0.2 * box["width"], middle)
    mouse.down()
    mouse.move(box["x"] + 0.8 * box["width"], middle, steps=10)
    panel.wait_for(lambda: any(wish["moving"] for wish in panel.talk.of("wish")))
    mouse.up()
    panel.wait_for(lambda: 0.7 < panel.changes.get("material.diffuse_weight", 0) < 0.9)
    panel.page.locator("#undo").click()
    panel.wait_for_changes({})


def test_what_is_typed_may_go_beyond_the_slider_but_not_beyond_the_field(panel: Panel) -> None:
    panel.tab("material")
    number, row = panel.typed("material.backlight"), panel.control("material.backlight")
    problem = row.locator(".problem")
    number.fill("7,5")
    number.press("Enter")
    panel.wait_for_changes({"material.backlight": 7.5})
    expect(panel.slider("material.backlight")).to_have_attribute("aria-valuetext", "7.5")
    number.fill("2")
    number.press("ArrowUp")
    expect(number).to_have_value("2.05")
    panel.wait_for_changes({"material.backlight": 2.05})
    panel.type("material.backlight", "7.5")
    number.fill("much")
    number.press("Enter")
    expect(problem).to_have_text('"much" is not a number.')
    expect(number).to_have_attribute("aria-invalid", "true")
    number.press("ArrowUp")
    expect(number).to_have_value("much")
    number.press("Escape")
    expect(problem).to_be_hidden()
    expect(number).to_have_value("7.5")
    number.fill("1e9")
    number.press("Tab")
    expect(problem).to_have_text("backlight must be at most 1000000.")
    panel.slider("material.backlight").press("ArrowLeft")
    expect(number).to_have_value("7.45")
    expect(problem).to_be_hidden()
    number.fill("-1/4")
    number.press("Enter")
    panel.wait_for_changes({"material.backlight": -0.25})
    expect(problem).to_be_hidden()


def test_numbers_that_must_be_whole_multiples_or_more_than_nothing(panel: Panel) -> None:
    panel.tab("shader")
    panel.control("occlusion.method").locator("select").select_option("screen-space")
    wrong = {
        "supersampling": ("1.5", "supersampling must be a whole number."),
        "occlusion.samples": ("6", "samples a pixel must be a multiple of 4."),
        "blur.step": ("0", "step must be more than 0."),
    }
    for path, (text, sentence) in wrong.items():
        panel.type(path, text)
        expect(panel.control(path).locator(".problem")).to_have_text(sentence)


def test_a_changed_control_is_marked_and_comes_back_three_ways(panel: Panel) -> None:
    panel.tab("material")
    row = panel.control("material.thickness_exponent")
    reset = row.get_by_role("button", name="Reset thickness exponent")
    height = row.evaluate("row => row.offsetHeight")
    for way in (row.locator(".label").dblclick, panel.slider("material.thickness_exponent").dblclick, reset.click):
        expect(row).not_to_have_class("changed")
        expect(reset).to_be_hidden()
        panel.typed("material.thickness_exponent").fill("18")
        panel.typed("material.thickness_exponent").press("Enter")
        expect(reset).to_be_visible()
        assert row.evaluate("row => row.offsetHeight") == height  # the rows below stay where they are
        way()
        panel.wait_for_changes({})
        expect(panel.typed("material.thickness_exponent")).to_have_value("25")
    expect(panel.slider("material.thickness_exponent")).to_be_focused()  # the button that had the focus is gone


def test_the_clicks_that_a_double_click_is_made_of_are_no_steps_of_undo(panel: Panel) -> None:
    panel.tab("material")
    panel.type("material.backlight", "0.3")
    panel.slider("material.diffuse_weight").dblclick(position={"x": 2, "y": 12})  # it was not changed: no step at all
    panel.tab("lights")
    panel.control("light.shadows").locator(".label").dblclick()  # each click toggles it
    panel.wait_for_changes({"material.backlight": 0.3})
    panel.tab("material")
    panel.slider("material.backlight").dblclick()
    expect(panel.typed("material.backlight")).to_have_value("1.2")
    for changes in ({"material.backlight": 0.3}, {}):
        panel.page.locator("#undo").click()
        panel.wait_for_changes(changes)


def test_a_finger_that_scrolls_leaves_the_slider_that_it_came_down_on(panel: Panel) -> None:
    panel.tab("material")
    devtools = panel.page.context.new_cdp_session(panel.page)

    def swipe(right: float, down: float) -> None:
        box = panel.slider("material.backlight").bounding_box()
        assert box
        x, y = box["x"] + box["width"] / 3, box["y"] + 12
        for kind, share in (("Start", 0), *(("Move", step / 4) for step in range(1, 5)), ("End", None)):
            points = [] if share is None else [{"x": x + share * right, "y": y + share * down}]
            devtools.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": points})

    number = panel.typed("material.backlight")
    swipe(0, -60)
    expect(panel.slider("material.backlight")).to_have_js_property("valueAsNumber", 400)
    swipe(0, 0)
    expect(number).to_have_value("0.95")
    panel.wait_for_changes({"material.backlight": 0.95})
    swipe(40, 2)
    panel.wait_for(lambda: panel.changes["material.backlight"] > 1.2)
    for changes in ({"material.backlight": 0.95}, {}):
        panel.page.locator("#undo").click()
        panel.wait_for_changes(changes)
    devtools.detach()


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


FITTED = [
    {},
    {"camera.field_of_view": 90},
    {"camera.distance": 0.5},
    {"camera.distance": 7, "camera.near": 6.5},
    {"camera.near": 30},
    {"size": [2000, 100], "light.shadows": True},
    {"light.shadows": True, "lights": [{"kind": "point", "distance": 1.1, "shadows": True}]},
    {"light.kind": "spot", "light.cutoff": 70, "light.distance": 1.05, "light.shadows": True, "size": [900, 900]},
    {"light.kind": "spot", "light.cutoff": 50, "light.distance": 0.5, "light.shadows": True, "size": [3, 3]},
]


def test_fields_left_empty_show_what_the_program_takes(panel: Panel) -> None:
    paths = ["camera.distance", "camera.near", "camera.far", "shadow.map_size", "layers.faces"]
    for changes in FITTED:
        scene = Scene().replace(changes)
        found = panel.page.evaluate(
            """async ([scene, paths]) => {
          const { fitted } = await import(new URL("static/fitted.js", location.href));
          const value = (path) => path.split(".").reduce((place, part) => place[part], scene);
          return paths.map((path) => value(path) ?? fitted(path, value, 1234));
        }""",
            [scene.model_dump(mode="json"), paths],
        )
        view = View.of(scene.camera, scene.size)
        casting = [light for light in (scene.light, *scene.lights) if light.shadows]
        side = atlas(casting, scene.shadow.map_size, scene.size).side
        # a given near plane beyond the fitted far one is not moved by the page: what counts then is the far plane
        assert found == pytest.approx([view.distance, view.near, view.far, side, 1234]), changes


def test_a_fitted_number_follows_what_it_is_fitted_to(panel: Panel) -> None:
    panel.tab("lights")
    expect(panel.typed("shadow.map_size")).to_have_value("256")
    panel.tab("shader")
    panel.control("size").locator("input").first.fill("2048")
    panel.control("size").locator("input").first.press("Enter")
    panel.tab("lights")
    expect(panel.typed("shadow.map_size")).to_have_value("4096")
    panel.control("light.kind").locator("select").select_option("point")
    panel.type("light.distance", "1")
    panel.control("light.shadows").locator("input").check()
    expect(panel.typed("shadow.map_size")).to_have_value("2730")  # six maps, three a row


def test_an_empty_field_can_be_set_and_left_empty_again(panel: Panel) -> None:
    panel.tab("camera")
    row = panel.control("camera.distance")
    auto = row.get_by_role("checkbox")
    expect(auto).to_be_checked()
    expect(row.locator("input.typed")).to_have_value("3.8637")
    auto.uncheck()
    panel.wait_for(lambda: panel.changes == {"camera.distance": pytest.approx(3.8637, abs=1e-4)})
    panel.slider("camera.distance").press("ArrowLeft")
    panel.wait_for(lambda: panel.changes["camera.distance"] < 3.8)
    auto.check()
    panel.wait_for_changes({})
    panel.slider("camera.distance").press("ArrowLeft")
    expect(auto).not_to_be_checked()
    panel.type("camera.distance", "")
    panel.wait_for_changes({})
    expect(auto).to_be_checked()
    expect(row.locator("input.typed")).to_have_value("3.8637")


def test_lights_are_added_picked_tuned_and_removed(panel: Panel) -> None:
    page = panel.page
    panel.tab("lights")
    add, remove = page.get_by_role("button", name="Add light"), page.get_by_role("button", name="Remove", exact=True)
    expect(remove).to_be_disabled()
    panel.type("light.elevation", "7")
    panel.type("light.azimuth", "170")
    add.click()
    expect(panel.typed("light.elevation")).to_have_value("7")  # a copy of the main light as it is now
    expect(panel.typed("light.azimuth")).to_have_value("-130")
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


def test_effects_say_why_they_are_left_out(panel: Panel) -> None:
    panel.tab("shader")
    page = panel.page
    specular, shadows = page.locator(".effect[data-effect=specular]"), page.locator(".effect[data-effect=shadows]")
    expect(shadows.locator(".reason")).to_have_text("left out: no light has shadows = true")
    expect(specular.locator(".reason")).to_have_text("simulated")
    specular.get_by_role("radio", name="off").check(force=True)
    expect(specular.locator(".reason")).to_have_text("left out: material.specular_contribution is 0")
    panel.wait_for(lambda: panel.settings["effects"] == {"specular": "off"})
    shadows.get_by_role("radio", name="on").check(force=True)
    expect(shadows.locator(".reason")).to_have_text("simulated")
    page.get_by_role("checkbox", name="technique").uncheck()
    expect(page.locator(".effect[data-effect=backlight]").get_by_role("radio", name="off")).to_be_checked()
    expect(page.locator(".effect[data-effect=blur] .reason")).to_contain_text("left out")
    panel.tab("material")
    expect(panel.control("material.backlight").locator(".otherwise")).to_have_text("off by hand, under Effects")
    expect(panel.slider("material.backlight")).to_be_hidden()
    panel.tab("shader")
    page.get_by_role("checkbox", name="technique").check()
    panel.wait_for(lambda: panel.settings["effects"] == {"specular": "off", "shadows": "on"})
    page.locator(".effect[data-effect=occlusion]").get_by_role("radio", name="off").check(force=True)
    expect(panel.control("occlusion.method").locator(".otherwise")).to_have_text("occlusion is off")


def test_a_quality_shows_what_it_sets_and_gives_way(panel: Panel) -> None:
    panel.tab("shader")
    row = panel.control("shadow.filter")
    samples, given = panel.typed("supersampling"), panel.control("occlusion.samples").locator(".given")
    panel.control("quality").locator("select").select_option("interactive")
    panel.wait_for_changes({"quality": "interactive"})
    expect(given).to_have_text("interactive")
    expected = Scene().replace({"quality": "interactive"})
    expect(panel.typed("occlusion.samples")).to_have_value(str(expected.occlusion.samples))
    expect(samples).to_have_value("1")  # the scene's own
    panel.tab("lights")
    assert row.locator("select").input_value() == f'"{expected.shadow.filter}"'
    row.locator("select").select_option("pcf")
    panel.wait_for_changes({"quality": "interactive", "shadow.filter": "pcf"})
    expect(row.locator(".given")).to_have_text("")
    row.get_by_role("button", name="Reset filter").click()
    panel.wait_for_changes({"quality": "interactive"})
    assert row.locator("select").input_value() == f'"{expected.shadow.filter}"'
    panel.tab("shader")
    panel.control("quality").get_by_role("button", name="Reset preset").click()
    expect(given).to_have_text("")


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


def test_a_measured_medium_is_one_step_of_undo(panel: Panel) -> None:
    panel.tab("material")
    page = panel.page
    page.get_by_label("medium").select_option("marble")
    expect(page.locator("#medium-numbers")).to_contain_text("2.19, 2.62, 3")
    page.get_by_label("object is").fill("0")
    page.get_by_role("button", name="Start from it").click()
    expect(page.locator("#medium-problem")).to_have_text("size must be more than 0.")
    page.get_by_label("object is").fill("40")
    page.get_by_role("button", name="Start from it").click()
    expected = starting_scene(BASE, MEDIA["marble"], 40).material
    panel.wait_for(lambda: panel.changes.get("material.diffuse") == list(expected.diffuse))
    assert panel.changes["material.thickness_exponent"] == expected.thickness_exponent
    page.locator("#undo").click()
    panel.wait_for_changes({})


def test_objects_by_name_and_by_faces(panel: Panel) -> None:
    panel.tab("shader")
    page = panel.page
    faces = page.get_by_label("faces", exact=True).first
    expect(faces).to_have_value("1000")
    page.locator("#object").select_option("torus")
    panel.wait_for_changes({"object": "torus:1000"})
    expect(page.locator("#object-name")).to_have_text("torus:1000")
    expect(page).to_have_title("torus:1000 – fakesss tune")
    faces.fill("12")
    faces.press("Enter")
    expect(page.locator("#object-problem")).to_have_text("faces must be at least 1000.")
    page.locator("#object").select_option("sphere")  # with as many faces as it had
    panel.wait_for_changes({})
    expect(faces).to_have_value("1000")
    expect(page.locator("#object-problem")).to_be_hidden()
    page.locator("#object").select_option("torus")
    faces.fill("many")
    faces.press("Enter")
    expect(page.locator("#object-problem")).to_have_text('"many" is not a number.')
    page.locator("#undo").click()
    expect(faces).to_have_value("1000")
    expect(page.locator("#object-problem")).to_be_hidden()
    page.locator("#redo").click()
    faces.fill("2000")
    faces.press("Enter")
    panel.wait_for_changes({"object": "torus:2000"})


def test_a_mesh_is_opened_or_dropped_anywhere(panel: Panel, tmp_path: Path) -> None:
    panel.tab("shader")
    page = panel.page
    mesh = tmp_path / "ball & chain.ply"
    mesh.write_bytes(trimesh.creation.icosphere(2).export(file_type="ply"))
    page.locator("#object-file").set_input_files(mesh)
    expect(page.locator("#object-notes")).to_contain_text("ball & chain.ply: 320 faces, 162 vertices.")
    expect(page.locator("#object option:checked")).to_have_text("ball & chain.ply")
    panel.wait_for(lambda: str(panel.changes.get("object", "")).endswith(".ply"))
    expect(page.locator("#object-name")).to_have_text("ball & chain.ply")
    page.locator("#previous").click()
    expect(page.locator("#caption")).to_have_text("The setting before: object sphere:1000")
    page.reload()
    expect(page.locator("#object-name")).to_have_text("ball & chain.ply")
    expect(page).to_have_title("ball & chain.ply – fakesss tune")
    expect(page.locator("#object option:checked")).to_have_text("ball & chain.ply")
    later = page.evaluate(
        """async () => {
      const { titled } = await import(new URL("static/object_names.js", location.href));
      return titled(`/cache/objects/${"17c0eaee".padEnd(64, "0")}.ply`);
    }"""
    )
    assert later == "17c0eaee….ply"
    page.locator("#undo").click()
    expect(page.locator("#object")).to_have_value("sphere")
    drop(page, "broken.ply", "ply\nthis is none")
    expect(page.locator("#object-problem")).to_contain_text("broken.ply")
    expect(page.locator("#drop")).to_be_hidden()
    drop(page, "box.obj", trimesh.creation.box().export(file_type="obj"))
    expect(page.locator("#object-notes")).to_contain_text("box.obj: 12 faces")


def drop(page: Page, name: str, text: str) -> None:
    """Drag a file over the page's heading and let it go there."""
    page.evaluate(
        """([name, text]) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([text], name));
      const target = document.querySelector("h1");
      for (const kind of ["dragenter", "dragover"]) {
        target.dispatchEvent(new DragEvent(kind, { dataTransfer, bubbles: true, cancelable: true }));
      }
      if (document.getElementById("drop").hidden) throw new Error("nothing says that a file can be dropped");
      const isLeft = target.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
      if (isLeft) throw new Error("the browser would leave the page for the file");
    }""",
        [name, text],
    )


def test_switches_move_and_show_what_they_say(panel: Panel) -> None:
    panel.tab("camera")
    page = panel.page
    page.get_by_label("speed").fill("fast")
    page.get_by_label("speed").press("Enter")
    expect(page.locator("#speed-problem")).to_have_text('"fast" is not a number.')
    page.get_by_label("speed").fill("90")
    page.get_by_role("checkbox", name="auto-rotation").check()
    panel.wait_for(lambda: "camera.azimuth" in panel.moved["changes"])
    page.get_by_role("checkbox", name="auto-rotation").uncheck()
    page.get_by_role("button", name="Reset camera").click()
    panel.wait_for_changes({})
    panel.tab("lights")
    page.get_by_role("checkbox", name="random lighting").check()
    panel.wait_for(lambda: "light.azimuth" in panel.moved["changes"])
    page.get_by_role("checkbox", name="random lighting").uncheck()
    panel.tab("shader")
    is_drawn = """() => {
      const { width, height } = document.getElementById("overlay");
      const pixels = document.getElementById("overlay").getContext("2d").getImageData(0, 0, width, height);
      return pixels.data.some((value) => value);
    }"""
    assert not page.evaluate(is_drawn)
    for name in ("bounding box", "axes"):
        page.get_by_role("checkbox", name=name).check()
        assert page.evaluate(is_drawn)
        page.get_by_role("checkbox", name=name).uncheck()


def test_shaders_are_read_again_and_all_values_printed(panel: Panel) -> None:
    panel.tab("material")
    panel.slider("material.backlight").press("ArrowRight")
    panel.tab("shader")
    page = panel.page
    page.get_by_text("Shaders and values").click()
    page.get_by_role("button", name="Reload shaders").click()
    expect(page.locator("#log")).to_contain_text(re.compile(r"Read again: \d+ shaders"))
    page.get_by_role("button", name="Print all values").click()
    printed = page.locator("#values").inner_text().splitlines()
    assert {line.partition(" = ")[0] for line in printed} == set(scene_paths()) - {"lights"}
    assert "material.backlight = 1.25" in printed
    assert "camera.distance = null" in printed
    expect(page.locator("#values")).to_be_focused()


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
