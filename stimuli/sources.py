"""What a study's pictures are made from, looked for before anything is drawn: objects, mesh files, pictures."""

from collections.abc import Iterable
from pathlib import Path

from fakesss.problem import BadInput
from stimuli.design import Stimulus
from stimuli.levels import leaves, written
from stimuli.study import Study


def check_sources(study: Study, stimuli: Iterable[Stimulus], folder: Path) -> None:
    """`BadInput` naming the place in study.toml of the first object or picture that is not there."""
    from fakesss.shapes import is_mesh_file, shape_and_faces  # slow to import, and not needed to read a study

    for name in dict.fromkeys(stimulus.scene.object for stimulus in stimuli if stimulus.scene):
        place = f"study.toml: {object_place(study, name)}"
        if is_mesh_file(name):
            check_file(folder / name, place)
        else:
            try:
                shape_and_faces(name)
            except BadInput as error:
                raise BadInput(f"{place}: {error}") from None
    for entry in study.compare:
        if entry.image is not None:
            check_file(folder / entry.image, f"study.toml: compare {written(entry.image)}")


def object_place(study: Study, name: str) -> str:
    """Where the study names the object: a factor's level, a control, a path-traced picture, or the base scene."""
    for factor in study.factor:
        if factor.path == "object" and name in factor.levels:
            return f'factor "{factor.name}": level {written(name)}'
    for entry in study.beside:
        if dict(leaves(entry.set)).get("object") == name:
            return f"{entry.where.removeprefix('study.toml: ')}: object {written(name)}"
    return f"scene.object {written(name)}"


def check_file(path: Path, place: str) -> None:
    """`BadInput` naming the place if the file cannot be read."""
    try:
        path.open("rb").close()
    except OSError as error:
        raise BadInput(
            f"{place}: cannot be read ({error.strerror or error}); check the file's name and place"
        ) from None
