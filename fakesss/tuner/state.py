"""What all of a tuner's endpoints work with."""

import asyncio
import contextlib
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from fastapi import Depends
from starlette.requests import HTTPConnection

from fakesss.mesh import Mesh
from fakesss.passes.mesh import identity
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.shapes import is_mesh_file, shape_and_faces
from fakesss.tuner.frames import MOST_SAMPLES, Asked, Drawn, draw, samples
from fakesss.tuner.preparing import Preparing
from fakesss.tuner.studio import Studio, Unprepared
from fakesss.tuner.uploads import Uploads
from fakesss.tuner.wishes import Settings

if TYPE_CHECKING:
    from fakesss.tuner.viewer import Viewer

LOOK_S = 0.5  # how often it is looked whether who waits for a picture is still there
WriteStudy = Callable[..., Any]
Result = TypeVar("Result")


async def always() -> bool:
    """Of a picture that somebody surely waits for."""
    return True


class Gone(Exception):
    """Nobody waits for this picture any more."""


@dataclass(eq=False)
class Tuner:
    """A scene to start from, what draws, and who looks."""

    base: Scene
    folder: Path  # files are written here
    shaders: Path
    write_study: WriteStudy | None = None
    loaded: Mesh | None = None  # the object of `base`, if that was read already
    viewers: "set[Viewer]" = field(default_factory=set)
    preparing: Preparing = field(default_factory=Preparing)
    uploads: Uploads = field(default_factory=Uploads)
    studio: Studio = field(init=False)

    def __post_init__(self) -> None:
        self.studio = Studio(self.shaders)

    async def begin(self) -> None:
        """Load the object before somebody asks; what is wrong with it is said to who does."""
        if self.loaded is not None:
            await self.studio.keep(("mesh", identity(self.base.object)), self.loaded)
        with contextlib.suppress(BadInput):
            await self.mesh(self.base.object)

    def scene(self, settings: Settings) -> Scene:
        """The scene of these settings; `BadInput` if it is none, or may not be drawn here."""
        scene = self.kept(settings)
        if samples(scene) > MOST_SAMPLES:
            width, height = scene.size
            raise BadInput(
                f"size {width}x{height} with supersampling {scene.supersampling}: is more than is drawn here while "
                "somebody waits; lower one of them, or save the scene and draw it with `fakesss render`"
            )
        return scene

    def kept(self, settings: Settings) -> Scene:
        """The same of any size, for a file."""
        scene = settings.scene(self.base)
        if not is_mesh_file(scene.object):
            shape_and_faces(scene.object)
        elif scene.object != self.base.object and not self.uploads.has(scene.object):
            raise BadInput(f'object "{scene.object}": is no file of this tuner; load it with its Load object button')
        return scene

    async def prepare(self, missing: Unprepared) -> None:
        """Make what a picture lacked."""
        await self.studio.keep(missing.key, await self.preparing(missing))

    async def picture(self, asked: Asked, is_wanted: Callable[[], Awaitable[bool]]) -> Drawn:
        """The picture itself, nothing standing in; `Gone` if by its turn nobody wants it any more."""
        return await self._made(partial(draw, asked=asked), is_wanted)

    async def mesh(self, name: str) -> Mesh:
        """The object of this name, loaded."""
        scene = self.base.replace({"object": name}, "tuner")
        return await self._made(lambda renderer: renderer.plan(scene)[1], always)

    async def _made(self, work: Callable[[Renderer], Result], is_wanted: Callable[[], Awaitable[bool]]) -> Result:
        while True:
            async with self.studio.turn:
                if not await is_wanted():
                    raise Gone
                try:
                    return await self.studio.do(work)
                except Unprepared as lack:
                    missing = lack
            making = asyncio.create_task(self.prepare(missing))
            try:
                while not (await asyncio.wait({making}, timeout=LOOK_S))[0]:
                    if not await is_wanted():
                        raise Gone
                await making
            finally:
                making.cancel()

    def close(self) -> bool:
        """Stop; whether everything has come to its end."""
        return self.preparing.close() & self.studio.close()


def tuner_of(connection: HTTPConnection) -> Tuner:
    """The tuner that an endpoint belongs to."""
    tuner: Tuner = connection.app.state.tuner
    return tuner


AtTuner = Annotated[Tuner, Depends(tuner_of)]
