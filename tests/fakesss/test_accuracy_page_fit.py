"""The page of `fakesss fit`: complete in one file, and every number of the document on it."""

import html
import re
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path

import pytest
from fit_document import SCENE, small_fit

from fakesss.accuracy.page_fit import write_fit_page
from fakesss.accuracy.page_fit_words import left_over
from fakesss.accuracy.page_numbers import rounded
from fakesss.colour import luminance
from fakesss.scene import Scene

pytestmark = pytest.mark.gl


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fit")
    write_fit_page(small_fit()[0], folder, small_fit()[1])
    return folder


@pytest.fixture(scope="module")
def page(folder: Path) -> str:
    return html.unescape((folder / "index.html").read_text(encoding="utf-8"))


def rows(page: str, anchor: str) -> Iterator[list[str]]:
    """The cells of a table's body."""
    body = page.split(f'<figure class="table" id="{anchor}">')[1].split("</figure>")[0].split("<tbody>")[1]
    for row in re.findall(r"<tr[^>]*>(.*?)</tr>", body):
        yield re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row)


def test_nothing_is_fetched_and_every_link_leads_somewhere(page: str, folder: Path) -> None:
    anchors = re.findall(r'\bid="([^"]+)"', page)
    assert len(anchors) == len(set(anchors))
    for address in re.findall(r'\b(?:href|src)="([^"]*)"', page):
        inside = address.startswith("data:image/png;base64,")
        assert inside or (address[1:] in anchors if address.startswith("#") else (folder / address).is_file()), address
    assert "<script" not in page


def test_the_sentence_comes_first_and_errors_stand_beside_noise(page: str) -> None:
    document = small_fit()[0]
    found = re.findall(r'<p class="finding">(.*?)</p>', page)
    assert found[0] == document["sentence"]
    for numbers in (document, document["start_errors"], document["noise"]):
        assert rounded(numbers["rmse"]) in found[1] and rounded(numbers["flip"]) in found[1]
    assert rounded(document["noise"]["misfit_rmse"]) in found[1]
    assert all(note in page for note in document["notes"])
    assert document["command"] in page and document["machine"]["gl_renderer"] in page


def test_every_parameter_stands_beside_its_start(page: str) -> None:
    parameters = small_fit()[0]["parameters"]
    found = {row[0]: row[1:] for row in rows(page, "table-parameters")}
    assert found["backlight"][:3] == [
        "wb",
        *(rounded(parameters["material.backlight"][k], 4) for k in ("start", "fitted")),
    ]
    for place, channel in enumerate("RGB"):
        entry = parameters["material.diffuse"]
        assert found[f"diffuse, {channel}"][:3] == ["Kd", *(rounded(entry[k][place], 4) for k in ("start", "fitted"))]
    assert len(found) == 5 + 3 + 1


def test_the_material_can_be_copied_into_a_scene(page: str) -> None:
    text = re.search(r'aria-label="The fitted material"><pre><code>(.*?)</code>', page, re.S)
    assert text
    material = Scene.from_dict(tomllib.loads(text[1]), "page").material
    document = small_fit()[0]
    fitted = {path: entry["fitted"] for path, entry in document["parameters"].items()}
    assert material == SCENE.replace({**fitted, "material.thickness": document["thickness"]["fitted"]}).material


def test_both_pictures_of_the_shader_stand_beside_the_target(page: str) -> None:
    alts = [alt for alt in re.findall(r'<img [^>]*alt="([^"]*)"', page) if alt]
    assert len(alts) == 1 + 2 * 3
    for name in ("the shader as it started", "the shader, fitted"):
        assert any(alt.startswith(f"Signed difference from the target, {name}: ×") for alt in alts)


def test_every_start_and_every_stretch_has_its_row(page: str) -> None:
    document = small_fit()[0]
    found = list(rows(page, "table-starts"))
    assert [(row[1], row[8]) for row in found] == [(s["thickness"], rounded(s["rmse"], 4)) for s in document["starts"]]
    for name, anchor in (("thickness", "table-thickness"), ("n_dot_l", "table-n-dot-l")):
        bins = document["leftover"][name]
        assert [row[1] for row in rows(page, anchor)] == [f"{each['pixels']:.1%}" for each in bins]


def test_times_are_multiples_of_the_shaders(page: str) -> None:
    document = small_fit()[0]
    assert [row[3] for row in rows(page, "table-times")][:3] == [
        "1", rounded(document["matched"]["speed_up"]), rounded(document["speed_up"])
    ]  # fmt: skip


def test_what_is_left_names_the_stretch_that_has_more_than_its_part() -> None:
    stretch = {"mean_error": [0, 0, 0]}
    bins = [
        {"from": 0.0, "to": 0.1, "pixels": 0.7, "share": 0.72, **stretch},
        {"from": 0.1, "to": 1.0, "pixels": 0.1, "share": 0.25, **stretch},
    ]
    (sentence,) = left_over({"thickness": bins})
    assert "25% where the object is 0.1 to 1 sphere diameters thick, in 10% of the pixels" in sentence
    assert left_over({"thickness": [{**each, "share": None} for each in bins]}) == []


def test_the_profile_crosses_most_of_the_object(page: str) -> None:
    covered = small_fit()[1]["target"][..., 3] > 0
    found = re.search(r"along row (\d+) of 32 and column (\d+) of 32", page)
    assert found
    row, column = (int(number) - 1 for number in found.groups())
    assert covered[row].sum() == covered.sum(axis=1).max() and covered[:, column].sum() == covered.sum(axis=0).max()
    assert luminance(small_fit()[1]["fitted"][row, :, :3]).max() > 0


def test_a_target_without_noise_and_a_perfect_fit_have_a_page(tmp_path: Path) -> None:
    document, pictures = deepcopy(small_fit()[0]), small_fit()[1]
    for numbers in (document, document["noise"]):
        numbers |= {"rmse": 0.0, "flip": 0.0, "max_abs": 0.0}
    for bins in document["leftover"].values():
        for each in bins:
            each["share"] = None
    page = write_fit_page(document, tmp_path, {**pictures, "fitted": pictures["target"]})
    assert "Signed difference from the target, the shader, fitted: no difference" in page.read_text()


def test_equal_documents_give_equal_bytes(folder: Path, tmp_path: Path) -> None:
    write_fit_page(small_fit()[0], tmp_path, small_fit()[1])
    names = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    assert len(names) == 1 + 2 * 4
    for name in names:
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes(), name
