"""Who may see /admin: one secret, compared in constant time, remembered in a signed cookie.

The secret is compared before guesses are counted, for otherwise anybody could lock the researcher out by guessing.
That leaves its length as what guessing fails on, so that a short one is refused at the start.
"""

import hashlib
import hmac
import time
from typing import Annotated

from fastapi import Depends, Request

from study_server.site import AtSite, Site

COOKIE_S = 12 * 3600
SHORTEST_SECRET = 16
"""Characters of a secret that is given by the environment."""


def is_secret(site: Site, given: str) -> bool:
    """Whether `given` is the admin secret, in a time that tells nothing about how much of it is right."""
    return hmac.compare_digest(given.encode(), site.admin_secret.encode())


def cookie_name(site: Site) -> str:
    """Of this database and mode: cookies are sent to every port of a host, and a pilot may run beside the study."""
    return f"fakesss_admin_{hashlib.sha256(site.signing_key.encode()).hexdigest()[:8]}"


def cookie_value(site: Site, now: float) -> str:
    """Until when the bearer may come in, signed."""
    until = str(int(now) + COOKIE_S)
    return f"{until}.{signature(site, until)}"


def signature(site: Site, until: str) -> str:
    """Depends on the secret too, so that a new secret closes the door to old cookies."""
    key = f"{site.signing_key}\0{site.admin_secret}".encode()
    return hmac.new(key, f"admin until {until}".encode(), "sha256").hexdigest()


def is_admin(request: Request, site: Site) -> bool:
    """Whether this request carries a valid cookie, or the secret as a bearer token."""
    until, _, signed = request.cookies.get(cookie_name(site), "").partition(".")
    if signed and hmac.compare_digest(signed.encode(), signature(site, until).encode()):
        return time.time() < int(until)
    scheme, _, given = request.headers.get("authorization", "").partition(" ")
    if scheme.lower() != "bearer":
        return False
    if is_secret(site, given.strip()):
        return True
    if not site.throttle.is_closed():
        site.throttle.note()
    return False


class Locked(Exception):
    """The admin's secret is needed."""


def unlocked(request: Request, site: AtSite) -> Site:
    """The site, for those who may see this page."""
    if not is_admin(request, site):
        raise Locked
    return site


Unlocked = Annotated[Site, Depends(unlocked)]
