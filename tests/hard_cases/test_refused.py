"""Cases that are no picture: exit code 2, and one sentence that names what, where and the mend."""

from pathlib import Path
from typing import Any

import pytest
import tomli_w
from catalogue import REFUSED
from hard_case import EVERYDAY, Case

from fakesss.cli import main


def scene_file(case: Case, folder: Path) -> Path:
    """The case's scene as a user would write it."""
    tables: dict[str, Any] = {}
    for path, value in {**EVERYDAY, **case.changes, "object": case.write(folder)}.items():
        *table, key = path.split(".")
        (tables.setdefault(table[0], {}) if table else tables)[key] = value
    path = folder / f"{case.name}.toml"
    path.write_bytes(tomli_w.dumps(tables).encode())
    return path


@pytest.mark.gl
@pytest.mark.parametrize("case", REFUSED.values(), ids=str)
def test_one_sentence(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / "picture.png"
    monkeypatch.setattr("sys.argv", ["fakesss", "render", str(scene_file(case, tmp_path)), "-o", str(picture)])
    with pytest.raises(SystemExit) as left:
        main()
    said = capsys.readouterr()
    assert left.value.code == 2 and said.out == "" and not picture.exists()
    assert said.err.startswith("fakesss: ") and said.err.count("\n") == 1
    assert case.outcome in said.err
