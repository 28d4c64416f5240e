"""Starting and stopping: nobody is lost, and what cannot be served says so in one sentence."""

import socket
import subprocess
import sys
from pathlib import Path

import httpx
import pytest
from study_fixture import write_study
from survey_client import JSON, Participant

from fakesss.listening import listening, own_addresses
from fakesss.problem import BadInput
from study_server.app import admin_secret, create_app
from study_server.serve import announce, serve, served


def test_a_restart_loses_nobodys_place(study: Path) -> None:
    with served(study) as url:
        person = Participant(url).to_trials()
        person.rate(3)
    with served(study) as url:
        state = httpx.get(f"{url}{person.here}", headers=JSON).json()
    assert (state["step"], state["trial"]) == ("trials", 2)


def test_a_port_in_use(study: Path) -> None:
    with listening("127.0.0.1", 0) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(BadInput, match=rf"127\.0\.0\.1:{port}: cannot be listened on .*; choose another"):
            serve(study, port=port)


def test_the_survey_needs_no_renderer() -> None:
    program = "import sys, study_server.serve, study_server.simulation.simulate; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    ours = {name for name in loaded if name.startswith("fakesss")}
    assert ours == {"fakesss", "fakesss.listening", "fakesss.problem"}
    assert not {"moderngl", "embreex", "trimesh", "stimuli", "analysis"} & set(loaded)


@pytest.mark.parametrize(
    ("host", "warns"), [("127.0.0.1", False), ("::ffff:127.0.0.1", False), ("::1", False), ("0.0.0.0", True)]
)
def test_what_is_printed_at_the_start(study: Path, capsys: pytest.CaptureFixture[str], host: str, warns: bool) -> None:
    announce(create_app(study), host, "http://127.0.0.1:8000")
    said = capsys.readouterr()
    assert said.out == ""
    assert "http://127.0.0.1:8000/admin" in said.err
    assert admin_secret(study) in said.err
    assert ("HTTPS" in said.err) is warns


@pytest.mark.parametrize("host", ["0.0.0.0", "::"])
def test_a_class_is_told_an_address_that_it_can_reach(
    study: Path, capsys: pytest.CaptureFixture[str], host: str
) -> None:
    own = own_addresses(socket.AF_INET)
    assert all(not address.startswith("127.") for address in own)
    announce(create_app(study), host, "http://127.0.0.1:8000")
    said = next(line for line in capsys.readouterr().err.splitlines() if "participants" in line)
    assert [f"http://{address}:8000/" in said for address in own] == [True] * len(own)
    assert ("127.0.0.1" in said) is (not own)
    announce(create_app(study), host, "http://127.0.0.1:8000", proxies=["10.0.0.1"])
    assert "http://127.0.0.1:8000/\n" in capsys.readouterr().err  # what the proxy asks


@pytest.mark.parametrize("proxy", ["0.0.0.0/0", "::/0", "10.0.0.1/8", "proxy.example"])
def test_everybody_is_no_proxy(study: Path, proxy: str) -> None:
    with pytest.raises(BadInput, match=f"--proxy {proxy}: .*; give "):
        serve(study, port=0, proxies=["127.0.0.1", proxy])


def test_a_port_that_is_none(study: Path) -> None:
    with pytest.raises(BadInput, match="70000: cannot be listened on"):
        serve(study, port=70_000)


def test_a_folder_that_cannot_be_written(study: Path) -> None:
    (study / "ratings.sqlite").mkdir()
    with pytest.raises(BadInput, match=r"ratings\.sqlite: cannot be opened for writing"):
        create_app(study)


def test_a_file_that_is_no_database(study: Path) -> None:
    (study / "ratings.sqlite").write_text("not a database, but long enough to be read as one" * 100)
    with pytest.raises(BadInput, match="cannot be opened for writing"):
        create_app(study)


@pytest.mark.parametrize("url", ["nonsense", "oracle+nothing://x", "sqlite:////nowhere/at/all.sqlite"])
def test_a_database_address_that_is_none(study: Path, url: str) -> None:
    with pytest.raises(BadInput):
        create_app(study, database_url=url)


def test_live_answers_to_another_study_are_not_mixed_with_these(study: Path) -> None:
    with served(study) as url:
        Participant(url).consent()
    write_study(study, survey={"practice": 2})
    with pytest.raises(BadInput, match=r"ratings\.sqlite: holds 1 live session\(s\) of another version of this study"):
        create_app(study)


def test_after_a_pilot_the_study_may_be_changed(study: Path) -> None:
    query = "?STUDY_ID=s&PROLIFIC_PID=p"
    with served(study, mode="pilot") as url:
        pilot = Participant(url, query).to_trials()
    write_study(study, survey={"practice": 2})
    with served(study) as url:
        assert Participant(url, query).consent().state["step"] == "about"
        assert httpx.get(f"{url}{pilot.here}", headers=JSON).status_code == 404
        assert pilot.here != Participant(url, query).here
