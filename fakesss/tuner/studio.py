"""The one thread that draws: OpenGL contexts belong to a thread, so viewers take turns."""

import asyncio
import ctypes
from collections.abc import Callable, Hashable
from concurrent.futures import ThreadPoolExecutor, wait
from pathlib import Path
from typing import Any, TypeVar

from fakesss.gpu import nothing
from fakesss.recent import Recent
from fakesss.renderer import Renderer, shared_renderer
from fakesss.shader_source import GLSL

BAKES_KEPT = 32  # meshes, whether they are solid, and their occlusion: those of several viewers
LEAVE_S = 0.5  # how long a picture that is being drawn is waited for at the end

Result = TypeVar("Result")


class Unprepared(Exception):
    """A picture needs what takes long to make: `make()` makes it, on any thread, for `Studio.keep`."""

    def __init__(self, key: Hashable, make: Callable[[], Any]) -> None:
        super().__init__(str(key))
        self.key, self.make = key, make

    @property
    def kind(self) -> str:
        """The baked resource's name, or "solid"."""
        return str(self.key[0]) if isinstance(self.key, tuple) else ""


class AtHand(Recent[Any]):
    """Bakes that were made elsewhere: what is missing is not made here, where others wait for pictures."""

    def get(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """The value of `key`, or `Unprepared`."""
        if key not in self.values:
            raise Unprepared(key, make)
        return super().get(key, make)


class Studio:
    """A renderer on a thread of its own; `BadInput` where there is no OpenGL. `glsl`: the folder of the shaders."""

    def __init__(self, glsl: Path = GLSL) -> None:
        self.glsl = glsl
        self.turn = asyncio.Lock()  # first come, first served; whoever leaves while waiting is passed over
        self._thread = ThreadPoolExecutor(1, "studio")
        self.renderer = self._thread.submit(self._open).result()

    def _open(self) -> Renderer:
        renderer = shared_renderer()
        renderer.bakes = AtHand(BAKES_KEPT)
        renderer.gpu.programs.root = self.glsl
        renderer.gpu.after_pass = wait_for_drawing()
        return renderer

    async def do(self, work: Callable[[Renderer], Result]) -> Result:
        """`work(renderer)` on the thread that draws, after what was asked of it before."""
        return await asyncio.get_running_loop().run_in_executor(self._thread, work, self.renderer)

    async def keep(self, key: Hashable, value: Any) -> None:
        """What an `Unprepared` picture lacked is at hand from now on."""
        await self.do(lambda renderer: Recent.get(renderer.bakes, key, lambda: value))

    async def read_shaders_again(self) -> None:
        """Forget every compiled program, and what programs drew."""
        await self.do(forget_programs)

    async def rest(self) -> None:
        """Give back the memory of textures: nobody looks just now."""
        await self.do(release_textures)

    def close(self) -> bool:
        """Free the context; False where a picture is still being drawn after `LEAVE_S`, which nothing can stop."""
        released = self._thread.submit(self.renderer.gpu.context.release)
        self._thread.shutdown(wait=False)
        return not wait([released], LEAVE_S).not_done


def wait_for_drawing() -> Callable[[], object]:
    """OpenGL's glFinish, called so that other threads go on; moderngl holds Python's lock while it waits for a pass.

    On a software rasteriser passes wait for one another anyway, so it takes no time. Without the library, nothing.
    """
    try:
        finish: Callable[[], object] = ctypes.CDLL("libGL.so.1").glFinish
    except OSError:
        return nothing
    return finish


def forget_programs(renderer: Renderer) -> None:
    """What compiled shaders are, and what they drew for later pictures."""
    renderer.gpu.drawn.clear()
    renderer.gpu.programs.compiled.clear()
    renderer.gpu.programs.defaults.clear()


def release_textures(renderer: Renderer) -> None:
    """What the next picture can make again."""
    renderer.gpu.drawn.clear()
    renderer.gpu.pool.release()
