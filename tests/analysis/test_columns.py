"""Files from elsewhere: names, delimiters, a column a picture, columns that hold levels."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from analysis import read_ratings, write_report
from analysis.levels import from_ratings, read_levels
from fakesss.cli import commands
from fakesss.cli_analysis import report
from fakesss.problem import BadInput

Write = Callable[[str], Path]
LONG = "participant,stimulus,question,rating\n"


def cells(frame: object) -> list[tuple[object, ...]]:
    """The four columns that every file has."""
    columns = ["participant", "stimulus", "question", "rating"]
    return list(frame[columns].itertuples(index=False, name=None))  # type: ignore[index]


@pytest.mark.parametrize("delimiter", [",", ";", "\t", "|"])
def test_any_delimiter_and_a_byte_order_mark(csv_of: Write, delimiter: str) -> None:
    text = (LONG + "p1,a,q,4\n").replace(",", delimiter)
    assert cells(read_ratings(csv_of("\ufeff" + text))) == [("p1", "a", "q", 4.0)]


def test_decimal_commas_where_the_comma_parts_no_cells(csv_of: Write) -> None:
    frame = read_ratings(csv_of("participant;stimulus;rating;rt_ms\np1;a, b;3,5;1200,25\n"), scale=None)
    assert (frame["rating"][0], frame["rt_ms"][0], frame["stimulus"][0]) == (3.5, 1200.25, "a, b")


def test_a_question_is_named_after_the_ratings(csv_of: Write) -> None:
    path = csv_of("who,photo,stars\np1,a,4\n")
    columns = {"participant": "who", "stimulus": "photo", "rating": "stars"}
    assert cells(read_ratings(path, columns)) == [("p1", "a", "stars", 4.0)]
    assert read_ratings(path, columns, question="shiny")["question"][0] == "shiny"


def test_a_column_a_picture(csv_of: Write) -> None:
    """An empty cell is missing; other columns are left alone."""
    frame = read_ratings(csv_of("Respondent ID,age,img1,img2,img10\n7,31,1,,3\n8,40,4,5,6\n"), wide="img*")
    assert [(c[0], c[1]) for c in cells(frame)] == [(p, f"img{i}") for p in "78" for i in (1, 2, 10)]
    assert frame["rating"].isna().tolist() == [False, True, False, False, False, False]
    assert set(frame["question"]) == {"rating"}


def test_a_column_a_picture_and_question(csv_of: Write) -> None:
    frame = read_ratings(csv_of("subject,a_shiny,b_shiny,a_flat\np1,1,2,3\n"), wide="{stimulus}_{question}")
    assert set(cells(frame)) == {("p1", "a", "shiny", 1.0), ("p1", "b", "shiny", 2.0), ("p1", "a", "flat", 3.0)}


def test_a_line_of_a_wide_file_is_named(csv_of: Write) -> None:
    with pytest.raises(BadInput, match='line 3: rating "9": must be a whole number from 1 to 7'):
        read_ratings(csv_of("subject,img1,img2\np1,1,2\np2,3,9\n"), wide="img*")
    with pytest.raises(BadInput, match=r'no column has the form "pic\*" \(wide\); '):
        read_ratings(csv_of("subject,img1,img2\np1,1,2\n"), wide="pic*")


def test_qualtrics_writes_three_header_lines(csv_of: Write) -> None:
    ids = '"{""ImportId"":""_recordId""}","{""ImportId"":""QID1""}"'
    frame = read_ratings(csv_of(f"ResponseId,img1\nResponse ID,Please rate\n{ids}\nR_1,5\nR_2,6\n"), wide="img*")
    assert cells(frame) == [("R_1", "img1", "rating", 5.0), ("R_2", "img1", "rating", 6.0)]


def test_blank_lines_count_as_lines(csv_of: Write) -> None:
    """Excel leaves rows of empty cells behind; lines are counted as an editor does."""
    assert len(read_ratings(csv_of(LONG + "p1,a,q,4\n\n,,,\n"))) == 1
    with pytest.raises(BadInput, match='line 4: rating "8"'):
        read_ratings(csv_of(LONG + "p1,a,q,4\n\np1,b,q,8\n"))


@pytest.mark.parametrize("cell", ['"x', "3,5"])
def test_cells_that_do_not_fit_the_header(csv_of: Write, cell: str) -> None:
    """An open quote, a cell too many: refused, never shifted."""
    with pytest.raises(BadInput, match=r"must be a CSV file|line 2: has 5 cells, the header 4"):
        read_ratings(csv_of(LONG + f"p1,a,q,{cell}\n"))


def test_bytes_that_are_no_text_far_below_the_header(tmp_path: Path) -> None:
    path = tmp_path / "latin.csv"
    path.write_bytes((LONG + "p1,a,q,4\n" * 20_000).encode() + "p2,Höhe,q,4\n".encode("latin-1"))
    with pytest.raises(BadInput, match="must be a CSV file in UTF-8"):
        read_ratings(path)


def test_an_excel_file(tmp_path: Path) -> None:
    (tmp_path / "r.xlsx").write_bytes(b"PK\x03\x04\xff\xfe")
    with pytest.raises(BadInput, match="an Excel file must be saved as CSV first"):
        read_ratings(tmp_path / "r.xlsx")


def with_levels(rows: Sequence[tuple[str, str, str]], people: int = 6) -> str:
    """Ratings of pictures with a lamp and a veil."""
    lines = [
        f"p{who},{name},{1 + (who * who + 3 * place + who * place) % 7},{lamp},{veil}\n"
        for who in range(people)
        for place, (name, lamp, veil) in enumerate(rows)
    ]
    return "participant,stimulus,rating,lamp,veil\n" + "".join(lines)


CROSSED = [("a", "10", "thin"), ("b", "2", "thin"), ("c", "10", "none"), ("d", "2", "none")]
FACTORS = {"light": "lamp", "veil": "veil"}


def test_levels_are_numbers_where_they_can_be(csv_of: Write) -> None:
    levels = read_levels(csv_of(with_levels(CROSSED)), {}, FACTORS)
    assert levels["a"] == {"light": 10, "veil": "thin"}
    commas = csv_of(with_levels(CROSSED).replace(",", ";").replace(";10;", ";1,5;"))
    assert read_levels(commas, {}, FACTORS)["a"]["light"] == 1.5


@pytest.mark.parametrize(
    ("rows", "design", "rows_of_b"),
    [
        (CROSSED, "full-factorial", ("light", "veil")),
        (CROSSED[:3], "one-at-a-time", ("light",)),
        ([*CROSSED[:2], ("c", "2", "none"), ("d", "5", "none")], "list", ("light", "veil")),
        ([*CROSSED, ("e", "", "")], "full-factorial", ("light", "veil")),
    ],
)
def test_the_design_is_read_off_the_levels(
    csv_of: Write, rows: list[tuple[str, str, str]], design: str, rows_of_b: tuple[str, ...]
) -> None:
    """Each picture in the rows where it belongs; one without levels stands outside."""
    path = csv_of(with_levels(rows))
    study = from_ratings(read_ratings(path), "x", 7, list(FACTORS), read_levels(path, {}, FACTORS))
    assert (study.design, study.picture("b").rows) == (design, rows_of_b)
    assert study.factors[0].levels == tuple(sorted({int(lamp) for _, lamp, _ in rows if lamp}))
    assert {p.role for p in study.pictures if p.id == "e"} <= {"compare"}


def test_an_unbalanced_file_of_levels_has_rows_by_factor(csv_of: Write, tmp_path: Path) -> None:
    results = write_report(csv_of(with_levels(CROSSED)), tmp_path / "out", factors=FACTORS)
    mine = [row for row in results["anova"] if row["method"] == "repeated measures"]
    assert [row["factor"] for row in mine][:2] == ["light", "veil"] and mine[0]["df1"] == 1


def test_contradictions_are_sentences(csv_of: Write, tmp_path: Path, thesis_manifest: Path) -> None:
    path = csv_of(with_levels(CROSSED))
    with pytest.raises(BadInput, match="the study says which picture has which level"):
        write_report(path, tmp_path / "out", factors=FACTORS, manifest=thesis_manifest)
    with pytest.raises(BadInput, match="write one row per rating"):
        write_report(path, tmp_path / "out", factors=FACTORS, wide="img*")
    with pytest.raises(BadInput, match=r'no column "lamb" .factor light.; did you mean "lamp"'):
        read_levels(path, {}, {"light": "lamb"})


def run(*words: str | Path) -> Result:
    """`fakesss report` in this process."""
    return CliRunner().invoke(commands, ["report", *map(str, words)])


def test_the_command_in_the_session_block_is_the_one_given(csv_of: Write, tmp_path: Path) -> None:
    """Without the folders of this machine; the plan is that of the file."""
    (tmp_path / "plan.toml").write_text("[analysis]\nalpha = 0.2\n")
    words = ["--ratings", csv_of(with_levels(CROSSED)), "--column", "rating=rating", "--factor", "light=lamp"]
    found = run(*words, "--factor", "veil", "--analysis", tmp_path / "plan.toml", "-o", tmp_path / "out", "--json")
    assert found.exit_code == 0, found.output
    page = (tmp_path / "out" / "results.json").read_text()
    assert (
        '"command": "fakesss report --ratings ratings.csv --column rating=rating --factor light=lamp --factor veil '
        '--analysis plan.toml"' in page
    )
    assert '"alpha": 0.2' in page and str(tmp_path) not in page


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ((), "nothing to analyse; name a STUDY, or a CSV with --ratings my.csv"),
        (("x", "--factor", "a"), "--factor: says how a CSV is read; name it with --ratings my.csv"),
        (("x", "--ratings", "y.csv", "--scale", "5"), "the study says each question's scale"),
        (("--ratings", "y.csv", "--column", "photo"), '--column "photo": must be OURS=THEIRS'),
        (("--ratings", "y.csv", "--factor", "=x"), '--factor "=x": must be NAME=COLUMN'),
        (("--ratings", "y.csv", "--scale", "1"), '--scale "1": must be a whole number from 2 to 1000, or none'),
        (("--ratings", "y.csv", "--analysis", "no.toml"), "no.toml: no such file"),
        (("--ratings", "y.csv"), "y.csv: no such file; check the path"),
    ],
)
def test_options_that_do_not_go_together(words: tuple[str, ...], sentence: str) -> None:
    found = run(*words)
    assert isinstance(found.exception, BadInput) and sentence in str(found.exception)


def test_a_plan_needs_its_table(tmp_path: Path) -> None:
    (tmp_path / "plan.toml").write_text("alpha = 0.1\n")
    found = run("--ratings", "y.csv", "--analysis", tmp_path / "plan.toml")
    assert "has no table [analysis]; write one" in str(found.exception)


def test_every_option_is_documented() -> None:
    docs = (Path(__file__).parents[2] / "docs" / "statistics.md").read_text(encoding="utf-8")
    theirs = {"column", "wide", "factor", "scale", "analysis", "participants"}
    assert theirs <= {option.removeprefix("--") for parameter in report.params for option in parameter.opts}
    assert all(f"--{name}" in docs for name in theirs)
