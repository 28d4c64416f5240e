"""Two versions of a study in one database: answers are never mixed, and those of either can be exported."""

import csv
import logging
import shutil
from pathlib import Path

import pytest
from study_fixture import write_study
from survey_client import Participant

from fakesss.problem import BadInput
from study_server.app import create_app
from study_server.exports.export import export_ratings, left_out
from study_server.serve import served
from study_server.storage.database import default_url


def rated(study: Path, out: Path, mode: str = "live", url: str | None = None) -> int:
    """How many ratings the export of `study` has."""
    export_ratings(study, out, mode=mode, database_url=url)  # type: ignore[arg-type]
    with (out / "ratings.csv").open(newline="") as file:
        return sum(bool(row["rating"]) for row in csv.DictReader(file))


def test_a_pilot_can_be_exported_after_the_study_was_changed(study: Path, tmp_path: Path) -> None:
    with served(study, mode="pilot") as url:
        assert Participant(url).to_trials().to_end()
    before = tmp_path / "before"
    shutil.copytree(study / "stimuli", before / "stimuli")
    write_study(study, survey={"practice": 2})
    with served(study) as url:
        Participant(url).consent()
    assert rated(study, tmp_path / "changed", "pilot") == 0
    assert left_out(study, "live") == [
        f"{default_url(study)}: also holds 1 session(s) of another version of this study, "
        "left out here; with the study's folder as it was then they can be exported"
    ]
    file = default_url(study)
    assert rated(before, tmp_path / "out", "pilot", file) == 6
    hints = left_out(before, "live", file)
    assert hints[:2] == [
        f"{file}: holds no live session of this study; the tables have no rows of people",
        f"{file}: also holds 1 pilot session(s), left out here; `fakesss export --mode pilot` writes them",
    ]
    assert len(hints) == 3
    assert len(left_out(before, "pilot", file)) == 1


def test_only_one_of_two_that_are_served_at_once_takes_live_sessions(
    tmp_path: Path, database_url: str, caplog: pytest.LogCaptureFixture
) -> None:
    first, second = write_study(tmp_path / "first"), write_study(tmp_path / "second", pictures=4)
    with served(first, database_url=database_url) as one, served(second, database_url=database_url) as two:
        person, refused = Participant(one).to_trials(), Participant(two)
        with caplog.at_level(logging.ERROR, "study_server.participant"):
            response = refused.client.post(f"{refused.here}/consent", json={})
        assert response.status_code == 409
        assert response.json()["error"].startswith("Another version of this study is under way")
        assert "another version of this study has live sessions in the same database" in caplog.text
        tester = Participant(two)
        tester.state["external"] = {"simulated": "yes"}
        assert tester.to_trials().to_end()
        assert person.to_end()
    assert rated(first, tmp_path / "out", url=database_url) == 6
    assert rated(second, tmp_path / "out2", "simulated", database_url) == 8
    create_app(first, database_url=database_url)
    mend = "move that file aside" if database_url.startswith("sqlite") else "name another database with --database"
    with pytest.raises(BadInput, match=mend):
        create_app(second, database_url=database_url)
