"""The numbers of the tuner's panel, by slider, keys, fingers and typing; each act is one step of undo."""

import pytest
from playwright.sync_api import expect
from tuner_panel import Panel

from fakesss.camera import View
from fakesss.scene import Scene
from fakesss.shadow_maps import atlas

pytestmark = [pytest.mark.browser, pytest.mark.gl]


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
