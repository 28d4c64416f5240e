"""What `serve` says at its start: where everything is, and whom and what it trusts."""

import os
from collections.abc import Sequence
from datetime import date

from sqlalchemy import text

from fakesss.listening import is_loopback, reached_by
from study_server.app import SECRET_VARIABLE
from study_server.site import Site
from study_server.storage.database import Database
from study_server.storage.engines import shown_url


def announcement(site: Site, url: str, address: str, proxies: Sequence[str], workers: int) -> str:
    """The lines, warnings last. `url`: where it is from here. `address`: the IP address that it listens on.

    A secret from the environment is not repeated: what is printed ends in logs.
    """
    is_local, urls = is_loopback(address), [url] if proxies else reached_by(address, url)
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
