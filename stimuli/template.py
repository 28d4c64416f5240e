"""`fakesss new`: commented study files to start from."""

from importlib.resources import files
from pathlib import Path

from fakesss.output import make_folder, write_atomically
from fakesss.problem import BadInput, nearest


def template_names() -> list[str]:
    """The templates shipped: thesis, minimal, factorial."""
    entries = (files("stimuli") / "templates").iterdir()
    return sorted(entry.name.removesuffix(".toml") for entry in entries if entry.name.endswith(".toml"))


def write_template(folder: Path, name: str = "thesis") -> Path:
    """`folder/study.toml` from a template; an existing study is never overwritten."""
    if name not in template_names():
        raise BadInput(f'template "{name}" is not known; {nearest(name, template_names())}')
    path = folder / "study.toml"
    if path.exists():
        raise BadInput(f"{path}: exists already; choose another folder or edit it")
    make_folder(folder)
    write_atomically(path, (files("stimuli") / "templates" / f"{name}.toml").read_bytes())
    return path
