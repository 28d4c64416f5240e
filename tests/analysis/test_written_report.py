"""The report as a reader gets it: files, words, numbers, and no host but the reader's own disk."""

import json
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from thesis_study import COMPARISON, stimulus, thesis_stimuli, write_manifest

from analysis import write_report
from fakesss.problem import BadInput

DATA = Path(__file__).parents[1] / "data" / "statistics"
REPEATED = DATA / "thesis_shaped_repeated_n44.csv"


class Addresses(HTMLParser):
    """Every src and href, all ids, and the text of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.addresses: list[str] = []
        self.ids: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href", "xlink:href")]
        self.ids += [value or "" for name, value in attrs if name == "id"]

    def handle_data(self, data: str) -> None:
        self.text += data


def read_page(path: Path) -> Addresses:
    """The page, parsed."""
    page = Addresses()
    page.feed(path.read_text(encoding="utf-8"))
    return page


@pytest.fixture(scope="module")
def thesis_report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the thesis-shaped report."""
    folder = tmp_path_factory.mktemp("thesis")
    manifest = write_manifest(
        folder / "study", thesis_stimuli(), {"alpha": 0.10, "adjust": "none", "comparison": [COMPARISON]}
    )
    told: list[tuple[int, int]] = []
    results = write_report(
        REPEATED, folder / "report", manifest=manifest, progress=lambda done, total, what: told.append((done, total))
    )
    assert told[0] == (0, 20) and told[-1] == (20, 20)
    assert json.loads((folder / "report" / "results.json").read_text()) == results
    return folder / "report"


def test_the_thesis_from_csv_to_results(thesis_report: Path) -> None:
    """Both modes in results.json, in contract.md's shape, with R's numbers."""
    results = json.loads((thesis_report / "results.json").read_text())
    assert (results["n_started"], results["n_completed"], results["alpha"]) == (44, 44, 0.10)
    assert {row["method"] for row in results["anova"]} == {"repeated measures", "independent samples"}
    first = results["anova"][0]
    assert (first["question"], first["factor"], first["method"]) == (
        "translucent",
        "thickness exponent",
        "repeated measures",
    )
    assert (first["F"], first["df1"], first["df2"]) == pytest.approx((22.4277022412616, 2, 86), rel=1e-9)
    assert first["ci"][0] < first["effect_size"] < first["ci"][1]
    hsd = next(row for row in results["hsd"] if row["factor"] == "offline images vs ours")
    assert (hsd["hsd_05"], hsd["hsd_01"]) == pytest.approx((0.821829079656403, 1.00253750447666), rel=1e-7)
    pair = next(row for row in results["tukey"] if (row["a"], row["b"]) == ("img10", "img12"))
    assert pair["difference"] == pytest.approx(1.0) and pair["verdict"] == "P < .05"


def test_the_page_says_it_in_words(thesis_report: Path) -> None:
    """Findings, tables in the thesis's form, sentences, captions, warnings."""
    page = read_page(thesis_report / "index.html")
    for words in (
        "Perceived <translucency> & more",
        "Rises with thickness exponent: 2.86 at 18, 3.80 at 25 and 5.25 at 30.",
        "Falls with backlight: 5.11 at 0.8, 4.45 at 1.2 and 4.05 at 1.6.",
        "HSD[.05] = 0.82; HSD[.01] = 1",
        "44 participants showed a significant effect of thickness exponent on ratings of “translucent”, "
        "F(1.67, 71.94) = 22.43, p < .001, η²G = .232, 90% CI [.132, .326]",
        "95% within-subject (Cousineau–Morey) confidence interval",
        "img01, img04, img07",
        'The "best" of 9 own pictures was picked by the same ratings',
    ):
        assert words in page.text


def test_same_input_same_bytes(thesis_report: Path, tmp_path: Path) -> None:
    """Pages, tables, figures and results."""
    before = {path.relative_to(thesis_report): path.read_bytes() for path in thesis_report.rglob("*") if path.is_file()}
    assert {path.suffix for path in before} == {".html", ".json", ".csv", ".svg", ".png"}
    out = tmp_path / "again"
    write_report(REPEATED, out, manifest=thesis_report.parent / "study" / "stimuli" / "manifest.json")
    after = {path.relative_to(out): path.read_bytes() for path in out.rglob("*") if path.is_file()}
    assert before == after


def test_the_page_needs_no_other_host(thesis_report: Path) -> None:
    """Nothing is fetched; links stay inside the report, and lead somewhere; ids are unique."""
    out = thesis_report
    page = read_page(out / "index.html")
    for address in page.addresses:
        assert address.startswith(("#", "data:image/jpeg;base64,")) or (out / address).is_file()
    style = re.search(r"<style>(.*?)</style>", (out / "index.html").read_text(), re.DOTALL)
    assert style is not None and "url(" not in style[1] and "@import" not in style[1]
    assert len(page.ids) == len(set(page.ids))
    assert {address[1:] for address in page.addresses if address.startswith("#")} <= set(page.ids)


def test_csv_tables_are_the_results(thesis_report: Path) -> None:
    """tables/anova.csv and results.json hold the same F."""
    results = json.loads((thesis_report / "results.json").read_text())
    table = pd.read_csv(thesis_report / "tables" / "anova.csv")
    assert table["F"].tolist() == pytest.approx([row["F"] for row in results["anova"]])


def some_pictures(folder: Path, *pictures: str) -> Path:
    """The repeated-measures ratings of these pictures alone, as a file of its own."""
    frame = pd.read_csv(REPEATED)
    path = folder / "some.csv"
    frame[frame["image"].isin(pictures)].to_csv(path, index=False)
    return path


def test_without_a_manifest_every_picture_is_a_sample(tmp_path: Path) -> None:
    """`report --ratings x.csv` alone: one row a question over all pictures."""
    results = write_report(some_pictures(tmp_path, "img03", "img10", "img11", "img12"), tmp_path / "out")
    mine = [row for row in results["anova"] if row["method"] == "repeated measures"]
    assert [(row["question"], row["factor"], row["df1"], row["df2"]) for row in mine] == [
        (name, "picture", 3, 129) for name in ("realistic", "translucent", "varnished")
    ]


def ratings_of(answers: dict[str, Callable[[int], int]], people: int) -> str:
    """CSV text: each picture's answers as a function of the participant's number."""
    rows = [f"p{who},{name},translucent,{rule(who)}\n" for who in range(people) for name, rule in answers.items()]
    return "participant,stimulus,question,rating\n" + "".join(rows)


def test_all_equal_is_said_not_invented(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """The report is written; the row has no F and the reason stands in the results and on the page."""
    path = csv_of(ratings_of({"img01": lambda who: 4, "img02": lambda who: 4, "img03": lambda who: 4}, 5))
    results = write_report(path, tmp_path / "out")
    assert [row["F"] for row in results["anova"]] == [None, None]
    sentence = "all ratings are equal, so F has no value"
    assert sentence in results["anova"][0]["reason"] and any(sentence in said for said in results["warnings"])
    assert sentence in read_page(tmp_path / "out" / "index.html").text
    assert "NaN" not in (tmp_path / "out" / "results.json").read_text()


def test_a_single_participant_is_said(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """One person cannot be compared with anybody."""
    path = csv_of(ratings_of({"img01": lambda who: 2, "img02": lambda who: 4, "img03": lambda who: 6}, 1))
    results = write_report(path, tmp_path / "out")
    assert "1 of 1 participants rated every level" in results["warnings"][0]


def test_fewer_people_than_pictures_is_said(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """Sphericity cannot be judged from three people and four pictures."""
    rules = {f"img0{i}": (lambda who, i=i: 1 + (who * i + i) % 7) for i in range(1, 5)}
    results = write_report(csv_of(ratings_of(rules, 3)), tmp_path / "out")
    assert any("3 participants for 4 levels; sphericity cannot be judged" in said for said in results["warnings"])


def test_a_factorial_is_averaged_over_the_other_factors(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """Main effect: each person's mean over the pictures of a level, then repeated measures."""
    levels = {"img01": (25, 0.8), "img02": (25, 1.2), "img03": (18, 0.8), "img04": (18, 1.2)}
    stimuli: list[dict[str, Any]] = [
        stimulus(
            int(name[3:]), role="factor", label=name, rows=["thickness exponent", "backlight"],
            factors={"thickness exponent": exponent, "backlight": light},
        )
        for name, (exponent, light) in levels.items()
    ]  # fmt: skip
    manifest = write_manifest(tmp_path / "study", stimuli, {"tests": []})
    rules = {name: (lambda who, i=i: 1 + (3 * who * who + 2 * i) % 7) for i, name in enumerate(levels)}
    path = csv_of(ratings_of(rules, 9))
    results = write_report(path, tmp_path / "out", manifest=manifest)
    frame = pd.read_csv(path).pivot(index="participant", columns="stimulus", values="rating")
    difference = (frame["img01"] + frame["img02"] - frame["img03"] - frame["img04"]) / 2
    t = difference.mean() / (difference.std() / 3)
    row = next(row for row in results["anova"] if row["factor"] == "thickness exponent")
    assert (row["df1"], row["df2"], row["F"]) == pytest.approx((1, 8, t**2))


def test_comparison_pictures_nobody_rated_are_left_out_with_a_sentence(tmp_path: Path, thesis_manifest: Path) -> None:
    """Own pictures only: rows 4.4 stand, the comparison is named as missing."""
    own = some_pictures(tmp_path, *(f"img0{number}" for number in range(1, 10)))
    results = write_report(own, tmp_path / "out", manifest=thesis_manifest)
    assert len(results["anova"]) == 18
    assert any(
        'comparison "offline images vs ours": nobody rated picture "img10"' in said for said in results["warnings"]
    )


def test_ratings_of_another_study(thesis_manifest: Path, csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """Told apart before anything is computed."""
    path = csv_of("participant,stimulus,question,rating\np1,bunny,translucent,3\n")
    with pytest.raises(BadInput, match=r'it has "bunny", the study has "img01".; are these ratings of another study'):
        write_report(path, tmp_path / "out", manifest=thesis_manifest)


def test_compared_pictures_without_a_declared_comparison(tmp_path: Path) -> None:
    """Pictures of other origin are compared with our best on every question."""
    manifest = write_manifest(tmp_path / "study", thesis_stimuli(), {"tests": []})
    rated = some_pictures(tmp_path, "img03", "img10", "img11")
    results = write_report(rated, tmp_path / "out", manifest=manifest)
    names = {row["factor"] for row in results["anova"]}
    assert names == {"translucent: others vs ours", "realistic: others vs ours", "varnished: others vs ours"}


@pytest.mark.parametrize("mode", ["simulated", "pilot"])
def test_answers_that_are_not_live_are_named_as_such(csv_of: Callable[[str], Path], tmp_path: Path, mode: str) -> None:
    """They are analysed where there are no others, and the first warning says so."""
    head, *rows = ratings_of({f"img0{i}": (lambda who, i=i: 1 + (who * i) % 7) for i in (1, 2, 3)}, 6).splitlines()
    other = [f"{mode},{row}" for row in rows]
    results = write_report(csv_of("\n".join([f"mode,{head}", *other])), tmp_path / "out")
    assert results["n_analysed"] == 6 and mode in results["warnings"][0]
    live = [f"live,{row.replace('p', 'person', 1)}" for row in rows[:12]]
    results = write_report(csv_of("\n".join([f"mode,{head}", *other, *live])), tmp_path / "out")
    assert results["n_analysed"] == 4 and not any(mode in said for said in results["warnings"])
