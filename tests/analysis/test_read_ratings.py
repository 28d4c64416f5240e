"""Ratings files: what is accepted under which names, and the sentence for every way to be wrong."""

from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from analysis import read_ratings
from fakesss.problem import BadInput
from study_server.exports.cells import cell

Write = Callable[[str], Path]
HEAD = "participant,stimulus,question,rating\n"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "is empty; it needs a header line with participant, stimulus, question, rating"),
        (HEAD, "has a header but no ratings"),
        (HEAD + "p1,a,q,0\n", 'line 2: rating "0": must be a whole number from 1 to 7'),
        (HEAD + "p1,a,q,4\np1,b,q,8\n", 'line 3: rating "8": must be a whole number from 1 to 7'),
        (HEAD + "p1,a,q,3.5\n", 'line 2: rating "3.5": must be a whole number from 1 to 7'),
        (HEAD + "p1,a,q,four\n", 'line 2: rating "four": must be a whole number from 1 to 7'),
        (HEAD + "p1,a,q,inf\n", 'line 2: rating "inf": must be'),
        (HEAD + "p1,a,q,nan\n", 'line 2: rating "nan": must be'),
        (HEAD + "p1,,q,4\n", "line 2: stimulus is empty; fill it in or delete the line"),
        (HEAD + "p1,a,q,4\np1,a,q,5\n", 'line 3: participant "p1" rated "a" on "q" twice'),
        (
            "participant,stimulus,question,ratin\n",
            'no column "rating"; did you mean "ratin"? Rename it in the header line',
        ),
        ("participant,rating,question,rating\n", 'two columns are called "rating"; rename one'),
    ],
)
def test_sentences(csv_of: Write, text: str, sentence: str) -> None:
    """One sentence with file, line and mend."""
    path = csv_of(text)
    with pytest.raises(BadInput) as error:
        read_ratings(path)
    assert sentence in str(error.value) and str(path) in str(error.value)


def test_missing_file(tmp_path: Path) -> None:
    """No traceback for a wrong path."""
    with pytest.raises(BadInput, match="no such file"):
        read_ratings(tmp_path / "nowhere.csv")


def test_not_text(tmp_path: Path) -> None:
    """A picture is not a table."""
    (tmp_path / "x.csv").write_bytes(b"\x89PNG\xff\xfe\x00")
    with pytest.raises(BadInput, match="must be a CSV file in UTF-8"):
        read_ratings(tmp_path / "x.csv")


@pytest.mark.parametrize(
    "head", ["participant,image,scale,rating", "Subject,Picture,Attribute,Response", "rater,item,dimension,score"]
)
def test_names_of_other_programs(csv_of: Write, head: str) -> None:
    """Aliases, in any case."""
    frame = read_ratings(csv_of(head + "\np1,a,shiny,4\n"))
    assert frame.iloc[0].to_dict() == {"participant": "p1", "stimulus": "a", "question": "shiny", "rating": 4.0}


def test_a_column_map_wins(csv_of: Write) -> None:
    """Whatever the columns are called; a wrong map names the nearest."""
    path = csv_of("who,photo,what,stars,image\np1,a,q,4,unused\n")
    columns = {"participant": "who", "stimulus": "photo", "question": "what", "rating": "stars"}
    assert read_ratings(path, columns)["stimulus"].tolist() == ["a"]
    with pytest.raises(BadInput, match=r'no column "fotos" .wanted as stimulus.; did you mean "photo"'):
        read_ratings(path, {**columns, "stimulus": "fotos"})


def test_order_is_natural_and_labels_are_kept(csv_of: Write) -> None:
    """ "image 10" after "image 2"; spaces, quotes, NA and letters beyond ASCII are only labels."""
    names = ['"image 10"', '"image 2"', "NA", '"say ""glow"""', "Ω"]
    frame = read_ratings(csv_of(HEAD + "".join(f"p1,{name},q,4\n" for name in names)))
    assert frame["stimulus"].tolist() == ["image 2", "image 10", "NA", 'say "glow"', "Ω"]


def test_row_order_does_not_matter(csv_of: Write) -> None:
    """The same rows in another order give the same frame."""
    rows = [f"p{who},{what},q,{1 + (who + len(what)) % 7}\n" for who in range(12) for what in ("a", "bb", "ccc")]
    forward, backward = (read_ratings(csv_of(HEAD + "".join(part))) for part in (rows, rows[::-1]))
    pd.testing.assert_frame_equal(forward, backward)


def test_latest_revision_and_live_only(csv_of: Write) -> None:
    """A changed answer counts as changed; pilots are left out; repeats and checks are no second answers."""
    head = "trial,participant,stimulus,question,rating,mode,revision,repeat_of,check_expected\n"
    rows = ["1,p1,a,q,2,live,0,,", "1,p1,a,q,6,live,1,,", "2,p1,a,q,5,live,0,a,", "3,p1,a,q,3,live,0,,3"]
    frame = read_ratings(csv_of(head + "\n".join([*rows, "1,p9,a,q,1,pilot,0,,"])))
    assert frame["rating"].tolist() == [6.0, 5.0, 3.0]
    unmarked = [*rows[:2], "2,p1,a,q,5,live,0,,"]
    with pytest.raises(BadInput, match="say which is a repeat in column repeat_of"):
        read_ratings(csv_of(head + "\n".join(unmarked)))


def test_the_apostrophe_of_the_export_is_taken_back(csv_of: Write) -> None:
    """What the export writes so that no spreadsheet runs it reads as it was; other apostrophes are the name's own."""
    names = ["=1+1", "+glow", "-5 %", "@noon", "'s Gravenhage", "don't"]
    frame = read_ratings(csv_of(HEAD + "".join(f"{cell(n)},{cell(n)},{cell(n)},4\n" for n in names)))
    for column in ("participant", "stimulus", "question"):
        assert sorted(frame[column]) == sorted(names)


def test_empty_rating_is_missing(csv_of: Write) -> None:
    """Not an error: the sample reports it."""
    assert read_ratings(csv_of(HEAD + "p1,a,q,\np1,b,q,4\n"))["rating"].isna().tolist() == [True, False]


def test_other_scales(csv_of: Write) -> None:
    """Each question its own; None allows any number."""
    path = csv_of(HEAD + "p1,a,q,9\np1,a,r,5\n")
    assert len(read_ratings(path, scale={"q": 9, "r": 5})) == 2
    with pytest.raises(BadInput, match="from 1 to 4"):
        read_ratings(path, scale={"q": 9, "r": 4})
    assert read_ratings(csv_of(HEAD + "p1,a,q,0.25\n"), scale=None)["rating"].iloc[0] == 0.25
