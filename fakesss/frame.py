"""Running a compiled frame graph: textures are taken and given back, every pass sees only what it declared."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from fakesss.frame_graph import DEPTH, Bake, Pass, Plan, TextureSpec
from fakesss.gpu import Gpu
from fakesss.memory import peak_bytes
from fakesss.recent import Recent
from fakesss.shader_source import NOTHING, ShaderError, feed

FULLSCREEN = "fullscreen.vert"
IN_PLACE = 2  # value of HAS_<INPUT> where the shader computes the input itself


@dataclass(frozen=True)
class Made:
    """A CPU-made resource: what it is, how long it took now (seconds) and whether it was at hand already."""

    value: Any
    seconds: float
    cached: bool


@dataclass(frozen=True)
class Outcome:
    """The targets of one run, bottom row first for pictures, and what each node cost."""

    values: Mapping[str, Any]
    baked: Mapping[str, Made]
    gpu_ms: Mapping[str, float]  # empty unless timed


@dataclass(frozen=True)
class Frame:
    """What a pass may touch while it draws: its inputs by name, its cleared target, and the context's tools."""

    gpu: Gpu
    node: Pass
    inputs: Mapping[str, Any]
    target: Any  # a moderngl.Framebuffer over `node.writes`

    def program(
        self,
        vertex: str,
        fragment: str,
        uniforms: Mapping[str, Any],
        defines: Mapping[str, Any],
        renamed: Mapping[str, str] = NOTHING,
    ) -> Any:
        """The program of two files, fed: `HAS_<INPUT>` follows the wiring, textures are bound under their names.

        `renamed` gives inputs that the shader knows by another name.
        """
        program = self.gpu.programs.get(vertex, fragment, {**self._wiring(fragment), **defines})
        samplers = {}
        for unit, (name, value) in enumerate(self.inputs.items()):
            if isinstance(value, moderngl.Texture) and name != self.node.mask:
                value.use(unit)
                samplers[renamed.get(name, name)] = unit
        feed(program, {**uniforms, **samplers})
        return program

    def fill(
        self,
        fragment: str,
        uniforms: Mapping[str, Any],
        renamed: Mapping[str, str] = NOTHING,
        /,
        **defines: int | float,
    ) -> None:
        """Run a fragment shader once for every pixel of the target, or every one that the pass's mask covers."""
        fed = dict(uniforms)
        for node in self.node.merged:
            if node.in_place:
                more_uniforms, more_defines = node.in_place(self.inputs)
                fed, defines = fed | more_uniforms, defines | more_defines
        program = self.program(FULLSCREEN, fragment, fed, defines, renamed)
        triangle = self.gpu.context.vertex_array(program, [])
        triangle.render(moderngl.TRIANGLES, vertices=3)
        triangle.release()

    def _wiring(self, fragment: str) -> dict[str, int]:
        asked = {name for name in self.gpu.programs.defaults_of(fragment) if name.startswith("HAS_")}
        known = {f"HAS_{name.upper()}": int(name in self.node.reads) for name in (*self.node.reads, *self.node.unread)}
        known |= {f"HAS_{name.upper()}": IN_PLACE for node in self.node.merged for name in node.writes}
        if unknown := asked - known.keys():
            raise ShaderError(f'{fragment}: {", ".join(sorted(unknown))} is no input of pass "{self.node.name}"')
        return {name: known[name] for name in asked}


@dataclass
class Run:
    """One execution of a plan; whatever happens, every texture goes back to the pool."""

    plan: Plan
    gpu: Gpu
    bakes: Recent[Any]
    timed: bool = False
    live: dict[str, Any] = field(default_factory=dict)
    lent: dict[str, TextureSpec] = field(default_factory=dict)
    baked: dict[str, Made] = field(default_factory=dict)
    queries: dict[str, Any] = field(default_factory=dict)

    def __call__(self, read: bool = True) -> Outcome:
        """Make every kept node; `read`: wait for the targets and read them back."""
        self.gpu.pool.allow(peak_bytes(self.plan))
        try:
            for node in self.plan.kept:
                self._make(node)
                for resource in self.plan.dead_after[node.name]:
                    self._give_back(resource)
            values = {name: self._value(name) for name in self.plan.targets} if read else {}
            gpu_ms = {name: query.elapsed / 1e6 for name, query in self.queries.items()}
            return Outcome(values, self.baked, gpu_ms)
        finally:
            for resource in tuple(self.live):
                self._give_back(resource)

    def _make(self, node: Pass | Bake) -> None:
        inputs = {name: self.live[self.plan.root(name)] for name in node.reads}
        if isinstance(node, Bake):
            self._bake(node, inputs)
            return
        wanted = not set(map(self.plan.root, self.plan.targets)).isdisjoint(node.writes)
        if node.key and not self.timed and not wanted:
            kept = self.gpu.drawn.get((node.name, node.key(inputs)), lambda: self._kept(node, inputs))
            self.live |= {name: texture for name, (_, texture) in kept.items()}
            return
        if node.key:
            self.gpu.drawn.clear()  # for the same to be drawn again beside it would take its memory twice
        self._take(node)
        if not self.timed:
            self._draw(node, inputs)
            return
        self.queries[node.name] = self.gpu.timer(node.name)
        with self.queries[node.name]:
            self._draw(node, inputs)

    def _take(self, node: Pass) -> None:
        for name, spec in node.writes.items():
            self.live[name] = self.gpu.pool.take(spec)
            self.lent[name] = spec

    def _kept(self, node: Pass, inputs: Mapping[str, Any]) -> dict[str, tuple[TextureSpec, Any]]:
        """What the pass draws now, no longer lent to this run: it outlives it."""
        self._take(node)
        self._draw(node, inputs)
        return {name: (self.lent.pop(name), self.live[name]) for name in node.writes}

    def _bake(self, node: Bake, inputs: Mapping[str, Any]) -> None:
        key = (node.name, node.key(inputs))
        cached, start = key in self.bakes, time.perf_counter()
        value = self.bakes.get(key, lambda: node.make(inputs))
        self.baked[node.name] = Made(value, time.perf_counter() - start, cached)
        self.live[node.name] = value

    def _draw(self, node: Pass, inputs: Mapping[str, Any]) -> None:
        size = next(iter(node.writes.values())).size
        colours = [self.live[name] for name, spec in node.writes.items() if spec.components != DEPTH]
        depth = next((self.live[name] for name, spec in node.writes.items() if spec.components == DEPTH), None)
        if node.depth_test and depth is None:
            depth = self.gpu.pool.depth_buffer(size)
        target = self.gpu.pool.framebuffer(colours, inputs[node.mask] if node.mask else depth)
        with self._drawing(node, target):
            node.draw(Frame(self.gpu, node, inputs, target))
        self.gpu.after_pass()

    @contextmanager
    def _drawing(self, node: Pass, target: Any) -> Iterator[None]:
        """The target emptied and bound, with the tests that the pass asks for."""
        context = self.gpu.context
        flags = moderngl.DEPTH_TEST if node.depth_test or node.mask else moderngl.NOTHING
        scope = context.scope(target, flags | (moderngl.BLEND if node.add else moderngl.NOTHING))
        try:
            with scope:
                target.depth_mask = not node.mask
                self._clear(node, target)
                # a mask keeps the full-screen triangle, which lies on the far plane, to where something is nearer
                context.depth_func = ">" if node.mask else "<"
                context.blend_func = moderngl.ONE, moderngl.ONE
                yield
        finally:
            context.depth_func = "<"
            scope.release()  # or half a kilobyte a pass would stay for good

    def _clear(self, node: Pass, target: Any) -> None:
        """Clearing a texture costs as much as drawing it: what nobody will see of it is left as it is."""
        colours = [name for name, spec in node.writes.items() if spec.components != DEPTH]
        needed = [name not in node.read_masked or name in map(self.plan.root, self.plan.targets) for name in colours]
        if all(needed):
            target.clear(*node.clear)
            return
        target.color_mask = tuple((need,) * 4 for need in needed)
        target.clear(*node.clear)
        target.color_mask = ((True,) * 4,) * len(needed)

    def _give_back(self, resource: str) -> None:
        value = self.live.pop(resource)
        if resource in self.lent:
            self.gpu.pool.give_back(self.lent.pop(resource), value)

    def _value(self, name: str) -> Any:
        """A picture as (H, W) or (H, W, components) float32, bottom row first; a baked resource as it is."""
        root = self.plan.root(name)
        if root not in self.lent:
            return self.live[root]
        spec = self.lent[root]
        width, height = spec.size
        flat: NDArray[np.float32] = np.frombuffer(self.live[root].read(), spec.numbers).astype(np.float32, copy=False)
        picture = flat.reshape(height, width, max(spec.components, 1))
        return picture[..., 0] if picture.shape[2] == 1 else picture
