"""What the page asks for besides frames: pictures for a grid, a material to start from, an object to load,
the shaders read again.
"""

from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import Field
from starlette.requests import Request
from starlette.responses import Response

from fakesss.media import medium_named
from fakesss.problem import BadInput, Strict
from fakesss.scene import Pixels, Scene
from fakesss.tuner.answers import Answer
from fakesss.tuner.frames import PICTURE, Asked
from fakesss.tuner.reload import read_again, stamps
from fakesss.tuner.state import AtTuner
from fakesss.tuner.uploads import MOST_BYTES
from fakesss.tuner.wishes import Settings

router = APIRouter()


class PictureAsked(Strict):
    """A picture of some settings, smaller if `size` says so."""

    settings: Settings = Settings()
    size: tuple[Pixels, Pixels] | None = Field(None, description="width, height in pixels; at most the scene's own")
    view: str = PICTURE


class MediumAsked(Strict):
    """A measured medium as a start for the material."""

    settings: Settings = Settings()
    medium: str
    size_mm: Annotated[float, Field(gt=0, le=1e6)] = Field(30.0, description="diameter of the bounding sphere, mm")


@router.post("/picture")
async def picture(asked: PictureAsked, tuner: AtTuner, request: Request) -> Response:
    """The picture as a PNG, without `size` byte for byte what `fakesss render` makes of the same scene."""
    scene = tuner.scene(asked.settings)
    if asked.size:
        check_smaller(asked.size, scene)
        scene = scene.replace({"size": asked.size}, "tuner")

    async def is_wanted() -> bool:
        return not await request.is_disconnected()

    drawn = await tuner.picture(Asked(scene, asked.settings.forced, asked.view), is_wanted)
    return Response(drawn.image, media_type=drawn.type)


def check_smaller(size: tuple[int, int], scene: Scene) -> None:
    """`BadInput` for a size beyond the scene's."""
    if size[0] > scene.size[0] or size[1] > scene.size[1]:
        given, own = (f"{width}x{height}" for width, height in (size, scene.size))
        raise BadInput(f"size {given}: is more than the scene's own {own}; ask for less")


@router.post("/reload")
async def reload(tuner: AtTuner) -> Answer:
    """The shaders as they are now, for everybody who looks: where a change of a file is not noticed by itself."""
    await read_again(tuner, list(stamps(tuner.shaders)))
    return Answer({})


@router.post("/medium")
def medium(asked: MediumAsked, tuner: AtTuner) -> Answer:
    """The changes that make the shader resemble a measured medium, before any fit."""
    from fakesss.offline.fit_start import starting_scene

    scene = tuner.scene(asked.settings)
    found = starting_scene(scene, medium_named(asked.medium, "medium"), asked.size_mm)
    before, after = (one.material.model_dump(mode="json") for one in (scene, found))
    return Answer({"changes": {f"material.{name}": after[name] for name in after if after[name] != before[name]}})


@router.post("/object", max_body_size=MOST_BYTES)
async def load_object(request: Request, tuner: AtTuner, name: Annotated[str, Query(max_length=255)]) -> Answer:
    """A mesh file, the request's body as it is: where it was put, and what is to be said of it."""
    path = await tuner.uploads.receive(name, request.stream())
    try:
        mesh = await tuner.mesh(str(path))
    except BadInput as error:
        path.unlink(missing_ok=True)
        raise BadInput(str(error).replace(str(path), f'"{name}"')) from None
    tuner.uploads.names[str(path)] = name
    return Answer(
        {"object": str(path), "faces": len(mesh.faces), "vertices": len(mesh.positions), "notes": mesh.repairs}
    )
