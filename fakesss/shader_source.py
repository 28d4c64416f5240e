"""GLSL assembled from files: `#include "x.glsl"` once each, defaults overridden by name.

A default stands in the GLSL as `#define NAME value // why`; a define without a comment is the file's own business and
cannot be overridden. moderngl's `Context.includes` is one level deep, and Mesa reports no file in its messages, so
sources are flattened here and compiler messages are mapped back to file and line.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from fakesss.recent import Recent

GLSL = Path(__file__).parent / "glsl"
VERSION = "#version 330 core"
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"\s*(//.*)?$')
DEFAULT = re.compile(r"^\s*#\s*define\s+([A-Z][A-Z0-9_]*)\s+(\S+)\s*//\s*\S")
KEPT = 64  # programs, of 1 to 5 MB on a software rasteriser; a study's pictures take about ten
NOTHING: Mapping[str, Any] = MappingProxyType({})


class ShaderError(ValueError):
    """A shader could not be assembled, compiled or fed; the message names file and line, or the name at fault."""


@dataclass(frozen=True)
class ShaderSource:
    """One flattened translation unit and, per line, where that line came from."""

    text: str
    origin: tuple[tuple[str, int], ...]  # origin[i] is the (file, line) of text line i + 1

    def locate(self, message: str) -> str:
        """A driver's message with its `0:12(3)` (Mesa, Apple) or `0(12)` (NVIDIA) replaced by `file:line`."""

        def place(match: re.Match[str]) -> str:
            file, line = self.origin[min(int(match[1]), len(self.origin)) - 1]
            return f"{file}:{line}"

        return re.sub(r"\b0[:(](\d+)(?:\(\d+\)|\))?", place, message)


def assemble(name: str, defines: Mapping[str, int | float] = NOTHING, root: Path = GLSL) -> ShaderSource:
    """Flatten the file `name` and its includes, each default named in `defines` replaced; raises `ShaderError`."""
    lines: list[tuple[str, str, int]] = []
    replaced: set[str] = set()
    seen: set[str] = set()

    def append(file: str, included_from: str) -> None:
        """The lines of a file and, in place, of those that it includes."""
        if file in seen:
            return
        seen.add(file)
        if not (root / file).is_file():
            raise ShaderError(f'{included_from}: no shader file "{file}" under {root}')
        for number, line in enumerate((root / file).read_text(encoding="utf-8").splitlines(), 1):
            if include := INCLUDE.match(line):
                append(include[1], f"{file}:{number}")
                continue
            if (default := DEFAULT.match(line)) and default[1] in defines:
                replaced.add(default[1])
                line = f"#define {default[1]} {defines[default[1]]!r}"
            lines.append((line, file, number))

    append(name, name)
    if unknown := set(defines) - replaced:
        raise ShaderError(f"{name}: no file of it declares a default for {', '.join(sorted(unknown))}")
    text = "\n".join([VERSION, *(line for line, _, _ in lines)]) + "\n"
    return ShaderSource(text, (("version", 1), *((file, number) for _, file, number in lines)))


def declared_defaults(name: str, root: Path = GLSL) -> frozenset[str]:
    """The names that `assemble(name, ...)` lets a caller replace."""
    return frozenset(match[1] for line in assemble(name, root=root).text.splitlines() if (match := DEFAULT.match(line)))


class Programs:
    """The `KEPT` compiled programs of one context used last, one per (vertex file, fragment file, defines).

    One that drops out is freed: who holds on to a program beyond the next `get` needs `Programs` of its own.
    """

    def __init__(self, context: object, root: Path = GLSL) -> None:
        self.context, self.root = context, root
        self.compiled: Recent[Any] = Recent(KEPT, dispose=lambda program: program.release())
        self.defaults: dict[str, frozenset[str]] = {}

    def get(self, vertex: str, fragment: str, defines: Mapping[str, int | float] = NOTHING) -> object:
        """The program of two files; `defines` go to the fragment shader. `ShaderError` names file and line."""
        key = (vertex, fragment, frozenset(defines.items()))
        return self.compiled.get(key, lambda: self._compile(vertex, fragment, defines))

    def defaults_of(self, name: str) -> frozenset[str]:
        """`declared_defaults`, read once."""
        if name not in self.defaults:
            self.defaults[name] = declared_defaults(name, self.root)
        return self.defaults[name]

    def _compile(self, vertex: str, fragment: str, defines: Mapping[str, int | float]) -> object:
        sources = {"vertex": assemble(vertex, NOTHING, self.root), "fragment": assemble(fragment, defines, self.root)}
        try:
            return self.context.program(  # type: ignore[attr-defined]
                vertex_shader=sources["vertex"].text, fragment_shader=sources["fragment"].text
            )
        except Exception as error:
            stage = "vertex" if "vertex_shader" in str(error) else "fragment"
            raise ShaderError(f"{vertex} + {fragment}: {sources[stage].locate(str(error))}") from error


def feed(program: Any, uniforms: Mapping[str, object]) -> None:
    """Set every uniform of a program; one too many or one too few is a `ShaderError`, never silence."""
    if program.extra is None:  # moderngl's place for what belongs to a program: its uniforms, and what they hold
        active = {name: program[name] for name in program if not name.startswith("gl_") and is_uniform(program[name])}
        program.extra = active, {}
    active, held = program.extra
    if unused := uniforms.keys() - active.keys():
        raise ShaderError(f"uniform {', '.join(sorted(unused))} is set but not used by the shader")
    if missing := active.keys() - uniforms.keys():
        raise ShaderError(f"uniform {', '.join(sorted(missing))} is used by the shader but not set")
    for name, value in uniforms.items():
        if held.get(name) != value:
            active[name].value = value
            held[name] = value


def is_uniform(member: object) -> bool:
    """Programs list attributes too; only uniforms have an array length and a location but no shape."""
    return type(member).__name__ == "Uniform"
