"""What `fakesss tune` says of where it is reached from."""

import pytest

from fakesss.cli_tune import network_hint, ssh_hint

URL = "http://127.0.0.1:8010/secret/"


@pytest.mark.parametrize("host", ["127.0.0.1", "127.0.0.2", "::1", "localhost"])
def test_nothing_is_said_of_this_machine_alone(host: str) -> None:
    assert network_hint(host, URL) == ""


@pytest.mark.parametrize(("host", "address"), [("0.0.0.0", ":8010/secret/"), ("192.0.2.7", URL)])
def test_a_tuner_that_others_reach_says_so_and_where(host: str, address: str) -> None:
    said = network_hint(host, URL)
    assert address in said and "unencrypted" in said


def test_who_is_here_by_ssh_is_told_the_way_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SSH_CONNECTION", "198.51.100.4 50000 192.0.2.9 22")
    assert ssh_hint(URL).endswith("ssh -L 8010:127.0.0.1:8010 192.0.2.9")
    monkeypatch.delenv("SSH_CONNECTION")
    assert ssh_hint(URL) == ""
