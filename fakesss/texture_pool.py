"""Textures, depth buffers and framebuffers that are handed out, taken back and handed out again."""

from dataclasses import dataclass, field
from typing import Any

import moderngl

from fakesss.frame_graph import TextureSpec


@dataclass
class TexturePool:
    """Transient float32 textures by spec. What is taken filters by nearest and clamps, whoever had it before."""

    context: Any
    free: dict[TextureSpec, list[Any]] = field(default_factory=dict)
    depth_buffers: dict[tuple[int, int], Any] = field(default_factory=dict)
    framebuffers: dict[tuple[int, ...], Any] = field(default_factory=dict)

    def take(self, spec: TextureSpec) -> Any:
        """A texture of this spec with unspecified contents."""
        spare = self.free.get(spec)
        texture = spare.pop() if spare else self.context.texture(spec.size, spec.components, dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        texture.repeat_x = texture.repeat_y = False
        texture.swizzle = "RGBA"
        return texture

    def give_back(self, spec: TextureSpec, texture: Any) -> None:
        """Take back a texture of `take`."""
        self.free.setdefault(spec, []).append(texture)

    def framebuffer(self, textures: list[Any], size: tuple[int, int], depth_test: bool) -> Any:
        """A framebuffer over `textures`, and a depth buffer of their size if wanted; reused while they live."""
        key = (*(texture.glo for texture in textures), int(depth_test))
        if key not in self.framebuffers:
            depth = self._depth_buffer(size) if depth_test else None
            self.framebuffers[key] = self.context.framebuffer(textures, depth)
        return self.framebuffers[key]

    def _depth_buffer(self, size: tuple[int, int]) -> Any:
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
