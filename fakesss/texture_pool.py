"""Textures, depth buffers and framebuffers that are handed out, taken back and handed out again."""

from dataclasses import dataclass, field
from typing import Any

import moderngl

from fakesss.frame_graph import DEPTH, TextureSpec

DTYPES = {"float32": "f4", "float16": "f2"}  # moderngl's names
KEPT = 1 << 28  # bytes: several kinds of picture at 512 x 512 with 3 x 3 samples

Attached = tuple[str, int]  # kind and OpenGL name of what a framebuffer is made of


def attached(thing: Any) -> Attached:
    """Textures and depth buffers are numbered apart."""
    return type(thing).__name__, thing.glo


@dataclass
class TexturePool:
    """Transient textures by spec. What is taken filters by nearest and clamps, whoever had it before.

    Before something is made, what was not used for longest is freed, so that all that was made takes no more than
    `KEPT` bytes, or what the picture at hand needs if that is more (`allow`).
    """

    context: Any
    limit: int = KEPT  # bytes
    held: int = 0  # bytes of all that was made and not freed, handed out or not
    free: dict[TextureSpec, list[Any]] = field(default_factory=dict)
    depth_buffers: dict[tuple[int, int], Any] = field(default_factory=dict)
    framebuffers: dict[tuple[Attached, ...], Any] = field(default_factory=dict)
    used: dict[TextureSpec | tuple[int, int], None] = field(default_factory=dict)  # in the order of their last use

    def allow(self, needed: int) -> None:
        """Keep to the limit for a picture that needs so many bytes from an empty pool (`memory.peak_bytes`)."""
        if needed:  # a plan may draw nothing, and the next one what the last one did
            self.limit = max(KEPT, needed)
            self._make_room(0)

    def take(self, spec: TextureSpec) -> Any:
        """A texture of this spec with unspecified contents."""
        spare = self.free.get(spec)
        texture = spare.pop() if spare else self._made(spec)
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        texture.repeat_x = texture.repeat_y = False
        if spec.components == DEPTH:
            texture.compare_func = ""  # read as data; a new one compares
        else:
            texture.swizzle = "RGBA"
        return texture

    def _made(self, spec: TextureSpec) -> Any:
        self._make_room(spec.bytes)
        if spec.components == DEPTH:
            texture = self.context.depth_texture(spec.size)
        else:
            texture = self.context.texture(spec.size, spec.components, dtype=DTYPES[spec.numbers])
        self.held += spec.bytes
        return texture

    def give_back(self, spec: TextureSpec, texture: Any) -> None:
        """Take back a texture of `take`."""
        self._note(spec)
        self.free.setdefault(spec, []).append(texture)

    def framebuffer(self, colours: list[Any], depth: Any) -> Any:
        """A framebuffer over textures and a depth buffer or None; reused while they live."""
        key = tuple(attached(thing) for thing in (*colours, depth) if thing is not None)
        if key not in self.framebuffers:
            self.framebuffers[key] = self.context.framebuffer(colours, depth)
        return self.framebuffers[key]

    def depth_buffer(self, size: tuple[int, int]) -> Any:
        """The depth buffer of this size for a pass that keeps it to itself."""
        if size not in self.depth_buffers:
            self._make_room(TextureSpec(size, DEPTH).bytes)
            self.depth_buffers[size] = self.context.depth_renderbuffer(size)
            self.held += TextureSpec(size, DEPTH).bytes
        self._note(size)
        return self.depth_buffers[size]

    def release(self) -> None:
        """Free everything that is not handed out: after a change of picture size the old sizes are dead weight."""
        for kind in tuple(self.used):
            self._free_all(kind)

    def _note(self, kind: TextureSpec | tuple[int, int]) -> None:
        self.used.pop(kind, None)
        self.used[kind] = None

    def _make_room(self, size: int) -> None:
        """Free what was not used for longest until `size` more bytes may be made."""
        for kind in tuple(self.used):
            if self.held + size <= self.limit:
                return
            self._free_all(kind)

    def _free_all(self, kind: TextureSpec | tuple[int, int]) -> None:
        """Free what is not handed out of textures of a spec, or the depth buffer of a size."""
        if isinstance(kind, TextureSpec):
            things, size = self.free.pop(kind, []), kind.bytes
        else:
            things = [self.depth_buffers.pop(kind)] if kind in self.depth_buffers else []
            size = TextureSpec(kind, DEPTH).bytes
        for thing in things:
            self._forget_framebuffers(attached(thing))
            thing.release()
            self.held -= size
        del self.used[kind]

    def _forget_framebuffers(self, part: Attached) -> None:
        """A name is given again after it was freed, and a framebuffer would outlive what it draws into."""
        for key in [key for key in self.framebuffers if part in key]:
            self.framebuffers.pop(key).release()
