"""Which files make a study's pictures stale when they change: those that draw, and no other.

Found again here by following imports from what the build calls, so a new module is told to whoever forgets it.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import fakesss
from stimuli.picture import NOT_DRAWING, drawing_files, tracing_files

ROOT = Path(fakesss.__file__).parent
MODULES = {path.relative_to(ROOT).with_suffix("").as_posix().replace("/", "."): path for path in ROOT.rglob("*.py")}
CALLED = ("__init__", "renderer", "image_io", "picture_reading", "shapes", "gpu")  # by stimuli.picture
OF_HIGHLIGHTS = {"renderer", "lighting_terms"}  # a picture with them depends on all that draws
OF_NO_PICTURE = {"__init__", "cache", "problem", "scene"}  # what a scene says is in the build key itself
LOOKS_INTO = ("renderer", "inspect")  # `render --views`, which no build asks for


def imports(module: str) -> Iterator[str]:
    """The modules of the package that one imports, also within functions."""
    for node in ast.walk(ast.parse(MODULES[module].read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "fakesss":
            base = (node.module or "").removeprefix("fakesss").removeprefix(".")
            names = [f"{base}.{alias.name}".removeprefix(".") for alias in node.names]
            yield from (name for name in (base, f"{base}.__init__", *names) if name in MODULES)


def drawing_modules(called: tuple[str, ...] = CALLED) -> set[str]:
    """All that is imported, directly or not, by what a build calls."""
    found: set[str] = set()
    waiting = list(called)
    while waiting:
        module = waiting.pop()
        if module not in found:
            found.add(module)
            waiting += [name for name in imports(module) if (module, name) != LOOKS_INTO]
    return found


def test_every_module_is_known_to_draw_or_not() -> None:
    stale = {path for path in drawing_files() if path.suffix == ".py" and path.is_relative_to(ROOT)}
    assert stale == {MODULES[module] for module in drawing_modules()}


def test_every_module_that_traces_is_known() -> None:
    traces = drawing_modules(("offline.path_tracing",)) - drawing_modules()
    offline = {module for module in traces if module.startswith("offline.")}
    called = {name for module in offline for name in imports(module)} | offline
    assert {MODULES[name] for name in called - OF_HIGHLIGHTS - OF_NO_PICTURE} <= set(tracing_files())


def test_every_shader_is_known_to_draw_or_not() -> None:
    named = {name for module in drawing_modules() for name in quoted(MODULES[module], r'"(\w+\.(?:frag|vert))"')}
    waiting = list(named)
    while waiting:
        included = quoted(ROOT / "glsl" / waiting.pop(), r'#include "(\w+\.glsl)"') - named
        named |= included
        waiting += included
    assert {path.name for path in drawing_files() if path.parent.name == "glsl"} == named
    assert {path.name for path in (ROOT / "glsl").iterdir()} - named == {"direct.frag", "direct.vert"}


def quoted(path: Path, pattern: str) -> set[str]:
    return set(re.findall(pattern, path.read_text(encoding="utf-8")))


def test_nothing_is_listed_that_is_not_there() -> None:
    assert {path.stem for path in [*MODULES.values(), *(ROOT / "glsl").iterdir()]} >= NOT_DRAWING
