"""The page's one script, and what names it to a browser that is told to run no other."""

import base64
import hashlib
from pathlib import Path

SCRIPT = (Path(__file__).parent / "templates" / "report.js").read_text(encoding="utf-8")


def script_source() -> str:
    """The script as a source of a Content-Security-Policy: 'sha256-...' of its bytes, quotes included."""
    digest = hashlib.sha256(SCRIPT.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"
