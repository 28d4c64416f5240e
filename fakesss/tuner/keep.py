"""What is taken home from the tuner: a scene's file, downloaded or written where the tuner was started; a study."""

import json
import re
import shlex
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter, Response
from pydantic import Field

from fakesss.output import write_new
from fakesss.problem import BadInput, Strict
from fakesss.scene_toml import scene_toml
from fakesss.tuner.state import AtTuner
from fakesss.tuner.wishes import Settings

router = APIRouter()

PLAIN = re.compile(r"\w([\w .-]{0,98}[\w-])?")
MOST_BYTES = 200  # of a name in UTF-8: file systems take 255, a suffix and a name that is written to first among them
RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)  # on Windows, whatever follows the dot


class Shown(Strict):
    """The settings on the stage."""

    settings: Settings = Settings()


class Named(Shown):
    """The same, and the name of the file to be written."""

    file: str


class Varied(Strict):
    """A scene field and its levels: `[[factor]]` of a study."""

    name: str
    path: str
    levels: Annotated[list[Any], Field(max_length=100)]


class Sweep(Shown):
    """A study around what is on the stage."""

    title: Annotated[str, Field(max_length=500)]
    folder: str
    factors: Annotated[list[Varied], Field(min_length=1, max_length=4)]


@router.post("/scene.toml")
def scene_file(tuner: AtTuner, asked: Shown) -> Response:
    """The scene as a file to download; a mesh is named by its whole path."""
    headers = {"Content-Disposition": 'attachment; filename="scene.toml"'}
    return Response(scene_toml(tuner.kept(asked.settings)), media_type="application/toml", headers=headers)


@router.post("/save")
def save(tuner: AtTuner, asked: Named) -> dict[str, str]:
    """Writes the scene's file into the folder; nothing is written over. A mesh that was uploaded is put beside it."""
    path = tuner.folder / file_name(asked.file)
    scene = tuner.kept(asked.settings)
    is_uploaded = tuner.uploads.has(scene.object)  # to the cache, which may be emptied
    mesh = path.with_suffix(Path(scene.object).suffix)
    named = scene.model_copy(update={"object": str(mesh)}) if is_uploaded else scene
    write_new(path, scene_toml(named, tuner.folder).encode())
    if is_uploaded:
        put_beside(path, mesh, Path(scene.object).read_bytes())
    return {"scene": str(path), "command": f"fakesss render {quoted(path)} -o {quoted(path.with_suffix('.png'))}"}


@router.post("/study")
def study(tuner: AtTuner, asked: Sweep) -> dict[str, str]:
    """Writes a study.toml into a folder within the folder: a new one, or one that holds no study yet."""
    if tuner.write_study is None:
        raise BadInput("study: this tuner was started by a program that writes none; start it with `fakesss tune`")
    factors = [factor.model_dump() for factor in asked.factors]
    for level in (level for factor in factors if factor["path"] == "object" for level in factor["levels"]):
        changes = {**asked.settings.changes, "object": level}
        tuner.kept(asked.settings.model_copy(update={"changes": changes}))  # a file that the tuner does not know
    folder = tuner.folder / plain_name(asked.folder, "folder")
    path = tuner.write_study(tuner.kept(asked.settings), asked.title, folder, factors)
    return {"study": str(path), "next": f"fakesss run {quoted(folder)}"}


def put_beside(scene: Path, mesh: Path, content: bytes) -> None:
    """A mesh beside the scene that names it, or neither of them."""
    try:
        write_new(mesh, content)
    except BadInput:
        scene.unlink(missing_ok=True)
        raise


def file_name(name: str) -> str:
    """The name of a scene's file in the folder, `.toml` added where it is missing."""
    name = plain_name(name, "file")
    name = name if name.endswith(".toml") else f"{name}.toml"
    if name == "study.toml":
        raise BadInput('file "study.toml": is the name of a study; choose another, for example scene.toml')
    return name


def plain_name(name: str, what: str) -> str:
    """`name` if it can only be something new in the folder, and on any system; `what` says whose name it is."""
    if not PLAIN.fullmatch(name) or RESERVED.fullmatch(name):
        mend = "write one name of letters, digits, spaces, dots and dashes, beginning with a letter or digit"
        raise BadInput(
            f"{what} {json.dumps(name, ensure_ascii=False)}: cannot be the name of a new {what} here; {mend}"
        )
    if len(name.encode()) > MOST_BYTES:
        raise BadInput(f"{what} {json.dumps(name, ensure_ascii=False)}: is too long for a file system; shorten it")
    return name


def quoted(path: Path) -> str:
    """A path as a shell reads it, from where the tuner was started if it lies there."""
    path = path.absolute()
    here = Path.cwd()
    return shlex.quote(str(path.relative_to(here) if path.is_relative_to(here) else path))
