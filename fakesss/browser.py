"""A Chromium on this machine: it prints reports, and the tests drive it."""

import os
import shutil

from fakesss.problem import BadInput

BROWSERS = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "microsoft-edge",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
)
VARIABLE = "FAKESSS_CHROMIUM"
MEND = f"apt-get install chromium, or set {VARIABLE}"


def find_browser() -> str:
    """Its path: what FAKESSS_CHROMIUM names, else the first of `BROWSERS`; `BadInput` in one sentence without any."""
    named = os.environ.get(VARIABLE)
    if named:
        found = shutil.which(named)
        if found is None:
            raise BadInput(f"{VARIABLE}: {named} is no program that can be run; name a Chromium or Chrome")
        return found
    path = next(filter(None, map(shutil.which, BROWSERS)), None)
    if path is None:
        raise BadInput(f"browser: no Chromium or Chrome is on the PATH; {MEND}")
    return path
