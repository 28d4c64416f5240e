"""What `serve` says at its start: where everything is, and whom and what it trusts."""

import contextlib
import ipaddress
import os
import socket
from collections.abc import Sequence
from datetime import date

from sqlalchemy import text

from study_server.app import SECRET_VARIABLE
from study_server.site import Site
from study_server.storage.database import Database
from study_server.storage.engines import shown_url

SOMEWHERE = {socket.AF_INET: "192.0.2.1", socket.AF_INET6: "2001:db8::1"}
"""Addresses of nobody (RFC 5737, RFC 3849): which of ours would send to them says by which others reach us."""


def announcement(site: Site, url: str, host: str, proxies: Sequence[str], workers: int) -> str:
    """The lines, warnings last. `url`: where it is from here. `host`: what it listens on.

    A secret from the environment is not repeated: what is printed ends in logs.
    """
    is_local, urls = is_loopback(host), [url] if proxies else reached_by(host, url)
    from_environment = bool(os.environ.get(SECRET_VARIABLE))
    secret = f"the one in {SECRET_VARIABLE}" if from_environment else f"{site.admin_secret} (kept in the database)"
    lines = [
        f"{site.study.title} ({site.mode})",
        f"  participants  {' or '.join(f'{url}/' for url in urls)}",
        f"  admin         {url}/admin   secret: {secret}",
        f"  report        {url}/admin/report/",
        f"  database      {shown_url(site.database.engine.url)}",
        f"  processes     {workers}",
        f"  proxies       {believed(proxies)}",
    ]
    told = [*overdue(site.study.settings.survey.retention_until), *warnings(site.database, is_local, bool(proxies))]
    return "\n".join([*lines, *(f"  {line}" for line in told)])


def overdue(retention_until: date | None) -> list[str]:
    """Participants read a date at consent that is past."""
    if retention_until is None or retention_until >= date.today():
        return []
    return [f"Warning: retention_until = {retention_until} is past: until then answers were to be kept."]


def is_loopback(host: str) -> bool:
    """Whether only this machine can connect."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def reached_by(host: str, url: str) -> list[str]:
    """Where others on the network find a server that listens on `host`, and on this machine is at `url`."""
    families = {"0.0.0.0": [socket.AF_INET], "::": [socket.AF_INET, socket.AF_INET6]}.get(host, [])
    port = url.rpartition(":")[2]
    found = [address for family in families for address in own_addresses(family)]
    return [f"http://{f'[{address}]' if ':' in address else address}:{port}" for address in found] or [url]


def own_addresses(family: socket.AddressFamily) -> list[str]:
    """This machine's on its networks: the one that leads outside first, then those that its own name has."""
    found = []
    with contextlib.suppress(OSError), socket.socket(family, socket.SOCK_DGRAM) as probe:  # no such network
        probe.connect((SOMEWHERE[family], 9))  # of a datagram's socket: nothing is sent
        found.append(probe.getsockname()[0])
    with contextlib.suppress(OSError):  # a name that nobody knows
        found += [str(known[4][0]) for known in socket.getaddrinfo(socket.gethostname(), None, family)]
    public = [address for address in dict.fromkeys(found) if "%" not in address]
    return [address for address in public if not ipaddress.ip_address(address).is_loopback]


def believed(proxies: Sequence[str]) -> str:
    """Whose word about addresses and encryption is taken."""
    if not proxies:
        return "none: X-Forwarded-For and X-Forwarded-Proto are not believed (--proxy)"
    return f"X-Forwarded-For and X-Forwarded-Proto are believed from {', '.join(proxies)}"


def warnings(database: Database, is_local: bool, has_proxies: bool) -> list[str]:
    """What could go wrong with these settings."""
    told = []
    if not is_local and not has_proxies:
        told.append("Warning: plain HTTP on a network; put an HTTPS proxy before it for people outside this room.")
    if not is_local and has_proxies:
        told.append("Warning: plain HTTP on a network; let only the proxy reach this port.")
    if not database.is_sqlite:
        with database.reading() as connection:
            if connection.scalar(text("SELECT current_setting('fsync')")) == "off":
                told.append("Warning: this PostgreSQL has fsync = off: a power cut can lose acknowledged answers.")
    return told
