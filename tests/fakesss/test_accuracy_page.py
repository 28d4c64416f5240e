"""The page of `fakesss tradeoff`: complete in one file, and every number of the document on it."""

import html
import re
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tradeoff_document import small

from fakesss.accuracy.drawings_maps import SIDE
from fakesss.accuracy.page import write_page
from fakesss.accuracy.page_numbers import rounded
from fakesss.problem import BadInput
from fakesss.scene import Scene

pytestmark = pytest.mark.gl

ADDRESS = re.compile(r'\b(?:href|src)="([^"]*)"')


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the small document's page is, beside its data."""
    folder = tmp_path_factory.mktemp("page")
    (folder / "tradeoff.json").write_text("{}")
    write_page(small()[0], folder, small()[1])
    return folder


@pytest.fixture(scope="module")
def page(folder: Path) -> str:
    return (folder / "index.html").read_text(encoding="utf-8")


def plain() -> dict[str, Any]:
    """A document of one knob, to be changed: one figure is enough where figures are not looked at."""
    document = deepcopy(small()[0])
    return document | {"knobs": document["knobs"][1:], "combinations": []}


def rows(page: str, anchor: str) -> Iterator[list[str]]:
    """The cells of a table's body."""
    body = page.split(f'<figure class="table" id="{anchor}">')[1].split("</figure>")[0].split("<tbody>")[1]
    for row in re.findall(r"<tr[^>]*>(.*?)</tr>", body):
        yield [html.unescape(cell) for cell in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row)]


def test_nothing_is_fetched_and_every_link_leads_somewhere(page: str, folder: Path) -> None:
    anchors = set(re.findall(r'\bid="([^"]+)"', page))
    addresses = ADDRESS.findall(page)
    assert "figures/figure-supersampling.svg" in addresses and "tradeoff.json" in addresses
    for address in addresses:
        inside = address.startswith("data:image/png;base64,")
        assert inside or (address[1:] in anchors if address.startswith("#") else (folder / address).is_file()), address
    assert "<script" not in page and "url(http" not in page


def test_ids_are_there_once(page: str) -> None:
    found = re.findall(r'\bid="([^"]+)"', page)
    assert len(found) == len(set(found))


def test_every_level_stands_in_its_table_with_its_numbers(page: str) -> None:
    for knob, anchor in zip(small()[0]["knobs"], ("table-supersampling", "table-blur-kernel"), strict=True):
        found = list(rows(page, anchor))
        assert [row[0].removesuffix(" (reference)") for row in found] == [str(p["value"]) for p in knob["points"]]
        for row, point in zip(found, knob["points"], strict=True):
            assert "96.5 % band" in page
            band = f"{rounded(point['ms_low'])}–{rounded(point['ms_high'])}"
            errors = [rounded(point[name]) for name in ("rmse", "max_abs", "flip", "flip_everywhere")]
            assert row[1:] == [rounded(point["ms"]), band, *errors]


def test_results_come_first_with_warnings_and_speed(page: str) -> None:
    text = html.unescape(page.split('id="results"')[1].split("</section>")[0])
    assert "Only two knobs." in text
    assert "interactive: 6.5 ms a picture, 2.5 times as fast as the preset reference." in text
    assert "reference: 16 ms a picture. Against" in text
    assert [row[:3] for row in rows(page, "table-overview")] == [
        ["supersampling", "3", "10 ms"], ["blur kernel", "5x5", "6.5 ms"]
    ]  # fmt: skip


def test_the_order_is_said_with_its_interval_and_what_is_expected(page: str) -> None:
    assert "N to the power of −1.07 (95 % interval 0.90 to 1.20), N being its number" in page
    assert "−1.00 is expected." in page


def test_combinations_stand_by_time_with_what_they_do_otherwise(page: str) -> None:
    found = list(rows(page, "table-combinations"))
    assert [row[0] for row in found] == ["4", "6.5", "10", "16"]
    assert [row[-2] for row in found] == ["", "interactive", "survey", "reference"]
    assert [row[-1] for row in found] == ["supersampling 1", "supersampling 2", "supersampling 3", "none"]


def test_presets_are_scene_files(page: str) -> None:
    """What is copied is read by a scene; a setting that is empty is left to its default."""
    presets = re.findall(r"Settings of the preset (\w+)\"><pre><code>(.*?)</code>", page, re.S)
    document = small()[0]["presets"]
    assert [name for name, _ in presets] == list(document)
    for name, text in presets:
        data = tomllib.loads(html.unescape(text))
        assert Scene.from_dict(data, name) == Scene().replace(document[name]["settings"])
        assert data == {"supersampling": document[name]["settings"]["supersampling"], "blur": {"enabled": True}}


def test_every_level_is_shown_with_its_difference_and_flip(page: str) -> None:
    shown = re.findall(r'<img src="data:[^"]*" width="(\d+)" height="(\d+)" alt="([^"]*)"', page)
    assert all(int(side) <= SIDE for width, height, _ in shown for side in (width, height))
    alts = [alt for _, _, alt in shown if alt]
    assert len(alts) == 1 + (1 + 3 * 4) + (1 + 3 * 1)
    for value in ("1", "2", "3", "4"):
        assert f"Picture at supersampling {value}" in alts
        assert any(re.match(rf"Signed difference .* supersampling {value}: ×\d+ \(2", alt) for alt in alts)
        assert any(alt.startswith(f"FLIP map at supersampling {value}, mean 0.") for alt in alts)
    assert page.count("level chosen") == 2


def test_a_picture_without_any_difference_says_so(tmp_path: Path) -> None:
    same = small()[1]["blur kernel", "5x5"]
    page = write_page(plain(), tmp_path, {("blur kernel", value): same for value in ("none", "5x5")})
    assert "Signed difference from the reference at blur kernel none: no difference" in page.read_text()


def test_published_times_stand_beside_ours(page: str) -> None:
    assert list(rows(page, "published-supersampling")) == [
        ["1", "4", "1", "2", "1", "1"], ["2", "6.5", "1.6", "4", "2", "1"], ["16", "", "", "32", "16", "1"]
    ]  # fmt: skip


def test_seconds_of_a_bake_take_the_place_of_a_pictures_time(tmp_path: Path) -> None:
    document = plain()
    for number, point in enumerate(document["knobs"][0]["points"]):
        point["bake_seconds"] = 0.5 * number
    page = write_page(document, tmp_path, {}).read_text()
    assert [row[:2] for row in rows(page, "table-blur-kernel")] == [["none", "0"], ["5x5 (reference)", "0.5"]]
    figure = page.split('id="caption-figure-blur-kernel"')[1].split("</figcaption>")[0]
    assert "what baking it costs" in figure and "band" not in figure


def test_a_document_without_pictures_has_all_but_them(tmp_path: Path) -> None:
    page = write_page(plain(), tmp_path, {}).read_text()
    assert "Picture at" not in page and page.count('class="plot') == 1


def test_equal_documents_give_equal_bytes(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "tradeoff.json").write_text("{}")
    write_page(small()[0], tmp_path, small()[1])
    names = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    assert len(names) == 2 + 2 * 3
    for name in names:
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes(), name


def test_names_are_text_and_never_html(tmp_path: Path) -> None:
    document = plain()
    document["scene"] = document["knobs"][0]["name"] = "<b>a&b</b>"
    page = write_page(document, tmp_path, {}).read_text()
    assert "<b>a&b" not in page and "&lt;b&gt;a&amp;b" in page


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(BadInput, match="file"):
        write_page(plain(), tmp_path / "file", {})


def test_twelve_knobs_stay_below_three_megabytes(tmp_path: Path) -> None:
    """Of eight levels each, with the grain of few rays, which packs worst, in every picture."""
    document, noise = plain(), np.random.default_rng(1)
    sharp = np.kron(small()[1]["", "reference"], np.ones((3, 3, 1), np.float32))
    knob = deepcopy(small()[0]["knobs"][0])
    without = write_page(document, tmp_path, {}).stat().st_size
    knob["points"] = [{**knob["points"][0], "value": value} for value in range(8)]
    document["knobs"].append({**knob, "reference": 7})
    grain = (1 + np.float32(noise.normal(0, 0.05, sharp.shape[:2])) * (sharp[..., 3] > 0) for _ in range(8))
    pictures = {("supersampling", str(value)): sharp * each[..., None] for value, each in enumerate(grain)}
    assert without + 12 * (write_page(document, tmp_path, pictures).stat().st_size - without) < 3e6
