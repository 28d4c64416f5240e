"""What the tuner's panel has beside single fields: effects, qualities, media, objects, switches, shaders."""

import re
from pathlib import Path

import pytest
import trimesh
from playwright.sync_api import Page, expect
from tuner_panel import BASE, Panel

from fakesss.media import MEDIA
from fakesss.offline.fit_start import starting_scene
from fakesss.scene import Scene, scene_paths

pytestmark = [pytest.mark.browser, pytest.mark.gl]


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
    page.locator(".effect[data-effect=backlight]").get_by_role("radio", name="on").check(force=True)
    page.get_by_role("checkbox", name="technique").uncheck()
    expect(page.locator(".effect[data-effect=backlight]").get_by_role("radio", name="off")).to_be_checked()
    expect(page.locator(".effect[data-effect=blur] .reason")).to_contain_text("left out")
    panel.tab("material")
    expect(panel.control("material.backlight").locator(".otherwise")).to_have_text("off by hand, under Effects")
    expect(panel.slider("material.backlight")).to_be_hidden()
    panel.tab("shader")
    page.get_by_role("checkbox", name="technique").check()  # as it was before
    panel.wait_for(lambda: panel.settings["effects"] == {"specular": "off", "shadows": "on", "backlight": "on"})
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
