"""Empirical translucency rendering. `Scene` describes a picture, `render` draws it.

The renderer is imported on first use, so that a machine without OpenGL can read scenes and errors.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fakesss.renderer import render
    from fakesss.scene import Scene

__all__ = ["Scene", "__version__", "render"]
__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    if name == "Scene":
        from fakesss.scene import Scene

        return Scene
    if name == "render":
        from fakesss.renderer import render

        return render
    raise AttributeError(f"module 'fakesss' has no attribute {name!r}")
