"""The report as a PDF, printed by a Chromium without a window."""

import os
import re
import subprocess
import tempfile
from pathlib import Path

from fakesss.browser import VARIABLE, find_browser
from fakesss.problem import BadInput

SWITCHES = (
    "--headless",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-extensions",
    "--disable-sync",
    "--no-first-run",
    "--no-pdf-header-footer",  # its own would print the date and the file's place
    "--generate-pdf-document-outline",
)
LINK_TO_FILE = re.compile(r'<a href="(?!#)[^"]*">')
PAPER = "<style>@page { size: A4; }</style></head>"
MOMENT = re.compile(rb"(/(?:CreationDate|ModDate) ?\(D:)\d{14}")


def write_pdf(page: Path, out: Path, timeout_s: float = 180) -> Path:
    """Prints the HTML file `page` into `out`; returns `out`.

    The browser is the one that `fakesss.browser` finds; it runs in a profile of its own that is thrown away. The PDF
    holds no date of its making. Raises `BadInput` without a browser, or where it fails or takes longer than
    `timeout_s` seconds.
    """
    browser = find_browser()
    with tempfile.TemporaryDirectory(prefix="fakesss-pdf-", ignore_cleanup_errors=True) as folder:
        copy, printed = Path(folder) / "report.html", Path(folder) / "report.pdf"
        copy.write_text(for_paper(page.read_text(encoding="utf-8")), encoding="utf-8")
        command = [browser, *SWITCHES, *sandbox(), f"--user-data-dir={folder}/profile", f"--print-to-pdf={printed}"]
        said = run([*command, copy.as_uri()], timeout_s)
        if not printed.is_file():
            raise BadInput(f"{browser}: printed no PDF ({said}); set {VARIABLE} to another Chromium")
        data = MOMENT.sub(rb"\g<1>20000101000000", printed.read_bytes())
    try:
        out.write_bytes(data)
    except OSError as error:
        raise BadInput(f"{out}: cannot write the PDF ({error.strerror}); choose a folder you may write to") from None
    return out


def for_paper(html: str) -> str:
    """The page on A4, without links to the files beside it: a PDF would hold this machine's paths in them."""
    return LINK_TO_FILE.sub("<a>", html).replace("</head>", PAPER, 1)


def sandbox() -> tuple[str, ...]:
    """Chromium refuses to start its sandbox as root. The page is our own and its policy lets it fetch nothing and run
    one script, so as root, and only then, it is printed without."""
    return ("--no-sandbox",) if hasattr(os, "geteuid") and os.geteuid() == 0 else ()


def run(command: list[str], timeout_s: float) -> str:
    """The last line that the browser said; with it every process that it started is ended."""
    with subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True
    ) as process:
        try:
            _, said = process.communicate(timeout=timeout_s)
        except subprocess.TimeoutExpired:
            end(process)
            raise BadInput(
                f"{command[0]}: took more than {timeout_s:g} s to print; set {VARIABLE} to another Chromium"
            ) from None
    lines = said.decode(errors="replace").strip().splitlines()
    return f"exit code {process.returncode}{': ' + lines[-1] if lines else ''}"


def end(process: "subprocess.Popen[bytes]") -> None:
    """The browser is several processes, in a session of their own."""
    if hasattr(os, "killpg"):
        os.killpg(process.pid, 9)
    else:
        process.kill()
    process.communicate()
