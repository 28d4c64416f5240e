"""What `fakesss tune` says of where it is reached from, whatever it was told to listen on, leads to it."""

import re
import shlex
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest
from tuner_server import running

from fakesss.cli_tune import network_hint, ssh_hint
from fakesss.listening import address_of, bound_to, listening
from fakesss.problem import BadInput
from fakesss.scene import Scene
from fakesss.shader_source import GLSL
from fakesss.tuner.guards import known_names
from fakesss.tuner.state import Tuner

MAPPED = "0:0:0:0:0:ffff:7f00:2"
HERE = ("127.0.0.1", "localhost", "127.1", "127.2", "127.0.0.2", "::1", MAPPED)
EVERYWHERE = ("0.0.0.0", "", "0", "::")


def heard(host: str) -> tuple[str, str]:
    """The URL of what listens on `host`, and the IP address that this is."""
    try:
        with listening(host, 0) as listener:
            return f"{address_of(listener)}/secret/", bound_to(listener)
    except BadInput:
        pytest.skip(f"{host or 'an empty host'}: no such address here")


@pytest.mark.parametrize("host", HERE)
def test_nothing_is_said_of_this_machine_alone(host: str) -> None:
    url, address = heard(host)
    assert network_hint(address, url) == ""


@pytest.mark.parametrize("host", [*EVERYWHERE, "192.0.2.7"])
def test_a_tuner_that_others_reach_says_so_and_where(host: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fakesss.listening.own_addresses", lambda family: ["192.0.2.7"])
    url, address = ("http://192.0.2.7:8010/secret/", host) if host == "192.0.2.7" else heard(host)
    said = network_hint(address, url)
    (there,) = set(re.findall(r"http://\S+/secret/", said))
    assert urlsplit(there).hostname == "192.0.2.7" and "unencrypted" in said
    assert known_names(host, address)("192.0.2.7")


@pytest.mark.parametrize("host", [*HERE, *EVERYWHERE])
def test_the_address_that_is_printed_is_let_in(host: str) -> None:
    url, address = heard(host)
    is_ours = known_names(host, address)
    asked = str(urlsplit(url).hostname)
    assert is_ours(f"[{asked}]" if ":" in asked else asked)


@pytest.mark.gl
@pytest.mark.parametrize("host", ["127.2", MAPPED])
def test_the_address_that_is_printed_answers(host: str, tmp_path: Path) -> None:
    heard(host)
    with running(Tuner(Scene(object="sphere:1000", size=(8, 8)), tmp_path, GLSL), host=host) as url:
        assert httpx.get(url + "start.json", timeout=60).status_code == 200


@pytest.mark.parametrize("host", [*HERE, *EVERYWHERE])
def test_who_is_here_by_ssh_is_told_the_way_back(host: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is carried over ends where something listens."""
    url, _ = heard(host)
    place = urlsplit(url)
    monkeypatch.setenv("SSH_CONNECTION", "198.51.100.4 50000 192.0.2.9 22")
    said = ssh_hint(url)
    command = shlex.split(said.partition("run  ")[2])
    assert command[:2] == ["ssh", "-L"] and command[3] == "192.0.2.9"
    assert command[2] == f"{place.port}:{place.netloc}"
    reached = place.hostname in ("127.0.0.1", "::1")
    assert reached or said.endswith(f"open http://127.0.0.1:{place.port}/secret/ there")
    monkeypatch.delenv("SSH_CONNECTION")
    assert ssh_hint(url) == ""


def test_where_another_way_leads_here_none_is_carried_over(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SSH_CONNECTION", "198.51.100.4 50000 192.0.2.9 22")
    assert ssh_hint("http://192.0.2.7:8010/secret/") == ""


@pytest.mark.parametrize("host", ["ü..x", "a\0b", "203.0.113.77"])
def test_a_host_that_cannot_be_listened_on_is_one_sentence(host: str) -> None:
    with (
        pytest.raises(BadInput, match=r"cannot be listened on \(.+\); choose another with --host$"),
        listening(host, 0),
    ):
        pass
