"""Textures, depth buffers and framebuffers that are handed out, taken back and handed out again."""

from dataclasses import dataclass, field
from typing import Any

import moderngl

from fakesss.frame_graph import DEPTH, TextureSpec


@dataclass
class TexturePool:
    """Transient float32 textures by spec. What is taken filters by nearest and clamps, whoever had it before."""

    context: Any
    free: dict[TextureSpec, list[Any]] = field(default_factory=dict)
    depth_buffers: dict[tuple[int, int], Any] = field(default_factory=dict)
    framebuffers: dict[tuple[int | str, ...], Any] = field(default_factory=dict)

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
        if spec.components == DEPTH:
            return self.context.depth_texture(spec.size)
        return self.context.texture(spec.size, spec.components, dtype="f4")

    def give_back(self, spec: TextureSpec, texture: Any) -> None:
        """Take back a texture of `take`."""
        self.free.setdefault(spec, []).append(texture)

    def framebuffer(self, colours: list[Any], depth: Any) -> Any:
        """A framebuffer over textures and a depth buffer or None; reused while they live."""
        key = (*(texture.glo for texture in colours), type(depth).__name__, getattr(depth, "glo", 0))
        if key not in self.framebuffers:
            self.framebuffers[key] = self.context.framebuffer(colours, depth)
        return self.framebuffers[key]

    def depth_buffer(self, size: tuple[int, int]) -> Any:
        """The depth buffer of this size for a pass that keeps it to itself."""
        if size not in self.depth_buffers:
            self.depth_buffers[size] = self.context.depth_renderbuffer(size)
        return self.depth_buffers[size]

    def release(self) -> None:
        """Free everything that is not handed out: after a change of picture size the old sizes are dead weight."""
        spare = [texture for textures in self.free.values() for texture in textures]
        for thing in (*self.framebuffers.values(), *self.depth_buffers.values(), *spare):
            thing.release()
        self.free.clear()
        self.depth_buffers.clear()
        self.framebuffers.clear()
