"""docs/deployment.md and the files it shows: commands are real, the files agree with one another and the program."""

import re
import shlex
import tomllib
from collections.abc import Iterator
from ipaddress import ip_address, ip_network
from pathlib import Path

import click
import pytest
import yaml

import fakesss.cli_analysis
import fakesss.cli_power
import fakesss.cli_study
import fakesss.cli_survey  # noqa: F401  (all add their commands)
from fakesss.cli import commands
from study_server import prompt
from study_server.app import SECRET_VARIABLE
from study_server.guards import rate_limit, throttle, web_safety
from study_server.guards.admin_door import SHORTEST_SECRET
from study_server.serve import FINISH_S
from study_server.storage.engines import AT_ONCE

DOCS = Path(__file__).parent.parent / "docs"
FILES = sorted((DOCS / "deployment").iterdir())
PAGES = ["deployment", "threat-model"]


def page(name: str) -> str:
    return (DOCS / f"{name}.md").read_text(encoding="utf-8")


def file(name: str) -> str:
    return (DOCS / "deployment" / name).read_text(encoding="utf-8")


def shown_commands(text: str) -> Iterator[list[str]]:
    """The words of every `fakesss ...` in code, up to a comment or what follows in a shell."""
    fence = re.compile(r"^```[^\n]*\n(.*?)^```", re.DOTALL | re.MULTILINE)
    code = fence.findall(text) + re.findall(r"`([^`\n]+)`", fence.sub("", text))
    for line in "\n".join(code).splitlines():
        found = re.search(r"(?:^|/|\s|=')fakesss ((?:[a-z]+)\b.*)", line)
        if found and not line.startswith(("adduser", "createdb", "sudo", "systemctl", "chown", "journalctl")):
            yield shlex.split(re.split(r"\s#|\s&&|\s\|\||'$", found[1])[0])


def check(words: list[str]) -> click.Context:
    """Parses a command as the program does; the files it names need not be there."""
    command = commands.commands[words[0]]
    for parameter in command.params:
        if isinstance(parameter.type, click.Path):
            parameter.type.exists = False
    return command.make_context(words[0], words[1:], resilient_parsing=False)


@pytest.fixture(autouse=True)
def paths_as_they_were() -> Iterator[None]:
    """`check` does not change what other tests see."""
    types = [parameter.type for command in commands.commands.values() for parameter in command.params]
    paths = [(kind, kind.exists) for kind in types if isinstance(kind, click.Path)]
    yield
    for kind, exists in paths:
        kind.exists = exists


@pytest.mark.parametrize("name", PAGES)
def test_commands_are_real(name: str) -> None:
    for words in shown_commands(page(name)):
        if len(words) > 1:
            check(words)
        else:
            assert words[0] in commands.commands


def test_the_page_shows_enough_commands() -> None:
    """The test above reads what is there."""
    shown = list(shown_commands(page("deployment")))
    assert any("--workers" in words for words in shown)
    assert {words[0] for words in shown} >= {
        "serve",
        "backup",
        "forget",
        "simulate",
        "power",
    }
    with pytest.raises(click.UsageError):
        check(["serve", "study", "--proxies", "x"])


def test_every_file_is_shown() -> None:
    shown = re.findall(r"literalinclude\} deployment/(\S+)", page("deployment"))
    assert sorted(shown) == [path.name for path in FILES]


def test_service_and_proxies_agree() -> None:
    """What systemd starts listens where the proxies ask, and believes them."""
    started = re.search(r"^ExecStart=\S+/fakesss (.+)$", file("fakesss.service"), re.MULTILINE)
    assert started
    serve = check(shlex.split(started[1])).params
    address = f"{serve['host']}:{serve['port']}"
    assert f"proxy_pass http://{address};" in file("nginx.conf")
    assert f"reverse_proxy {{$SURVEY_ADDRESS:{address}}}" in file("Caddyfile")
    assert "127.0.0.1" in str(serve["proxy"])
    assert f"ReadWritePaths={serve['study']}\n" in file("fakesss.service")
    for name in ("nginx.conf", "Caddyfile"):
        assert started[1].partition(" --")[2] in file(name)  # the first line says what it stands before
    backup = re.search(r"/fakesss (backup \S+ -o) ", file("fakesss-backup.service"))
    assert backup and str(serve["study"]) in backup[1]
    assert f"{SECRET_VARIABLE}=" in file("fakesss.service")
    stop = re.search(r"TimeoutStopSec=(\d+)", file("fakesss.service"))
    assert stop and int(stop[1]) > FINISH_S
    assert "RestartPreventExitStatus=2\n" in file("fakesss.service")  # bad input stays bad


def test_proxies_pass_what_the_server_asks_for() -> None:
    nginx, caddy = file("nginx.conf"), file("Caddyfile")
    for line in ("Host $http_host;", "X-Forwarded-For $remote_addr;", "X-Forwarded-Proto $scheme;"):
        assert f"proxy_set_header {line}" in nginx
    assert nginx.count("error_log /var/log/nginx/fakesss.log crit;") == nginx.count("server {")
    assert nginx.count("access_log off;") == nginx.count("server {") == 2
    assert f"client_max_body_size {web_safety.BODY_LIMIT // 1024}k;" in nginx
    assert f"max_size {web_safety.BODY_LIMIT // 1024}KiB" in caddy
    assert f"client_header_timeout {prompt.HEAD_S:.0f}s;" in nginx
    assert f"client_body_timeout {web_safety.BODY_S:.0f}s;" in nginx
    assert f"read_header {prompt.HEAD_S:.0f}s" in caddy
    assert "exclude http.log.error" in caddy


def test_the_containers_agree() -> None:
    container, compose = file("Containerfile"), yaml.safe_load(file("compose.yaml"))
    entry = re.search(r'^ENTRYPOINT \["fakesss", (.+)\]$', container, re.MULTILINE)
    assert entry
    words = re.findall(r'"([^"]+)"', entry[1])
    survey = compose["services"]["survey"]
    serve = check([*words, *survey["command"]]).params
    assert f"EXPOSE {serve['port']}\n" in container
    assert f"http://127.0.0.1:{serve['port']}/health" in container
    assert serve["study"] == Path("/study") or serve["study"] == "/study"
    assert "VOLUME /study\n" in container
    assert container.index("USER fakesss") < container.index("ENTRYPOINT")
    proxy = compose["services"]["proxy"]
    assert serve["proxy"] == proxy["networks"]["default"]["ipv4_address"]  # and nobody else on that network
    (network,) = compose["networks"]["default"]["ipam"]["config"]
    assert ip_address(serve["proxy"]) in ip_network(network["subnet"])
    assert proxy["environment"] == {"SURVEY_ADDRESS": f"survey:{serve['port']}"}
    assert "ports" not in survey  # the proxy alone is reached from outside
    database = compose["services"]["database"]["environment"]
    assert f"postgresql://{database['POSTGRES_USER']}@database/{database['POSTGRES_DB']}" == serve["database"]
    assert SECRET_VARIABLE in survey["environment"]


def test_the_image_holds_the_program_and_nothing_else() -> None:
    """What the build may copy: everything is left out first, then the program's own is let in."""
    root = DOCS.parent
    lines = [line for line in (root / ".dockerignore").read_text().splitlines() if not line.startswith("#")]
    let_in = {line[1:] for line in lines if line.startswith("!")}
    assert lines[0] == "*" and "**/__pycache__" in lines
    project = tomllib.loads((root / "pyproject.toml").read_text())
    packages = {pattern.removesuffix("*") for pattern in project["tool"]["setuptools"]["packages"]["find"]["include"]}
    files = {"pyproject.toml", "constraints.txt", project["project"]["readme"], *project["project"]["license-files"]}
    assert let_in == packages | files


def test_numbers_are_those_of_the_program() -> None:
    model, deployment = page("threat-model"), page("deployment")
    for words in (
        f"{rate_limit.PER_SECOND:.0f} a second on average, {rate_limit.AT_ONCE} at once",
        f"{rate_limit.STARTS_PER_SECOND:.0f} a second, {rate_limit.STARTS_AT_ONCE} at once",
        f"{rate_limit.SIMULATED_PER_SECOND:.0f} a second, {rate_limit.SIMULATED_AT_ONCE:,} at once",
        f"{throttle.GUESSES} a minute",
        f"{web_safety.BODY_LIMIT // 1024} KiB, {web_safety.BODY_S:.0f} s",
        f"{prompt.HEAD_LIMIT // 1024} KiB, {prompt.HEAD_S:.0f} s",
        f"refused below {SHORTEST_SECRET} characters",
    ):
        assert words in model, words
    assert f"up to {2 * AT_ONCE} connections" in deployment
    assert f"({FINISH_S} s at most)" in deployment


def test_tests_that_are_named_are_there() -> None:
    here = {path.name for path in Path(__file__).parent.rglob("test_*.py")}
    for name in PAGES:
        assert set(re.findall(r"\btest_\w+\.py", page(name))) <= here
