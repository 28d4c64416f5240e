"""The only place where an OpenGL context is created.

Linux: off-screen through EGL, on a graphics card or on Mesa's software rasteriser, whichever the system offers first.
macOS and Windows: moderngl's default backend, untested.

A `Gpu` belongs to the thread and the process that made it: `shared()` keeps one per thread, and a process that was
forked gets its own. Use the "spawn" start method for worker processes, since Mesa's threads do not survive a fork.
"""

import os
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import moderngl

from fakesss.frame_graph import TextureSpec
from fakesss.problem import BadInput
from fakesss.recent import Recent
from fakesss.shader_source import Programs
from fakesss.texture_pool import TexturePool

REQUIRED = 330
MEND = "run `apt-get install libegl1 libgl1 libegl-mesa0 libgl1-mesa-dri` (Debian, Ubuntu) or install the card's driver"
EXPLICIT_NAMES = {"libgl": "libGL.so.1", "libegl": "libEGL.so.1"}
REFUSALS = ("create", "framebuffer is not complete")  # Mesa makes the texture and then cannot attach it
UPLOADS_KEPT = 16  # buffers: a few meshes, so that a sweep uploads nothing twice
DRAWN_KEPT = 1  # passes' outputs that the next picture may use again: large, so only the last


def nothing() -> None:
    """What is done after a pass, unless somebody has something to do then."""


@dataclass
class Gpu:
    """A context with its compiled programs, pooled textures and recently uploaded buffers."""

    context: Any
    programs: Programs = field(init=False)
    pool: TexturePool = field(init=False)
    uploads: Recent[Any] = field(init=False)
    timers: dict[str, Any] = field(default_factory=dict)
    drawn: Recent[Any] = field(init=False)  # textures of passes with a key, {name: (spec, texture)}
    after_pass: Callable[[], object] = nothing

    def __post_init__(self) -> None:
        self.programs = Programs(self.context)
        self.pool = TexturePool(self.context)
        self.uploads = Recent(UPLOADS_KEPT, dispose=lambda upload: upload.release())
        self.drawn = Recent(DRAWN_KEPT, dispose=self._forget)

    def _forget(self, textures: Mapping[str, tuple[TextureSpec, Any]]) -> None:
        for spec, texture in textures.values():
            self.pool.give_back(spec, texture)

    def keep_drawn(self, spec: TextureSpec | None) -> None:
        """Give back what an earlier picture left, unless it left a texture like the one that this picture has."""
        if spec not in (kept for textures in self.drawn.values.values() for kept, _ in textures.values()):
            self.drawn.clear()

    def timer(self, name: str) -> Any:
        """The timer query of this name: moderngl cannot release one, so each is made once."""
        if name not in self.timers:
            self.timers[name] = self.context.query(time=True)
        return self.timers[name]

    @property
    def renderer(self) -> str:
        """What draws, in the driver's words: equal strings promise equal bytes."""
        return str(self.context.info["GL_RENDERER"])

    @property
    def version(self) -> str:
        """The driver's OpenGL version string."""
        return str(self.context.info["GL_VERSION"])


def create() -> Gpu:
    """A new off-screen context with OpenGL 3.3 or later, or `BadInput` naming the mend."""
    try:
        context = first_context()
    except Exception as error:
        raise BadInput(f"OpenGL: no off-screen context ({str(error).splitlines()[0]}); {MEND}") from error
    if context.version_code < REQUIRED:
        found = f"{context.version_code // 100}.{context.version_code % 100 // 10}"
        context.release()
        raise BadInput(f"OpenGL: version {found} found where 3.3 is needed; {MEND}")
    warm_up_timer(context)
    return Gpu(context)


def warm_up_timer(context: Any) -> int:
    """Time the clearing of one pixel, in nanoseconds: on Mesa a context's first such query reads 2^32 - 1."""
    target = context.simple_framebuffer((1, 1))
    with (query := context.query(time=True)):
        target.clear()
    elapsed = int(query.elapsed)
    target.release()
    return elapsed


def first_context() -> Any:
    """moderngl's context; on Linux once more with the libraries' full names, for systems without `-dev` links."""
    create_context: Any = moderngl.create_context  # its type stub does not know the backends' own arguments
    if not sys.platform.startswith("linux"):
        return create_context(standalone=True)
    try:
        return create_context(standalone=True, backend="egl")
    except Exception:
        return create_context(standalone=True, backend="egl", **EXPLICIT_NAMES)


@contextmanager
def reporting_memory(what: str, mend: str) -> Iterator[None]:
    """Turn the driver's "out of memory" and its refusal of huge textures and framebuffers into one sentence.

    `what` takes most memory, as a plural; `mend` makes it smaller.
    """
    try:
        yield
    except (moderngl.Error, MemoryError) as error:
        if not isinstance(error, MemoryError) and not any(word in str(error) for word in REFUSALS):
            raise
        raise BadInput(f"OpenGL: {what} do not fit into memory ({error}); {mend}") from error


_threads = threading.local()


def shared() -> Gpu:
    """This thread's context, created at the first call."""
    if getattr(_threads, "owner", None) != os.getpid():
        _threads.gpu, _threads.owner = create(), os.getpid()
    gpu: Gpu = _threads.gpu
    return gpu


def renderer_facts() -> dict[str, str]:
    """Who draws on this thread, for manifests: `gl_renderer` and `gl_version`. Opens the context."""
    gpu = shared()
    return {"gl_renderer": gpu.renderer, "gl_version": gpu.version}
