"""One renderer for all hard cases, and one folder with the mesh files that they need."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from fakesss.gpu import shared
from fakesss.renderer import Renderer


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Each mesh file is written once."""
    return tmp_path_factory.mktemp("meshes")


@pytest.fixture(scope="session")
def session_renderer() -> Renderer:
    renderer = Renderer(shared())
    renderer.bakes.limit = 100  # no case's mesh is loaded twice
    return renderer


@pytest.fixture
def renderer(session_renderer: Renderer) -> Iterator[Renderer]:
    """The renderer, with no OpenGL error before and none after the test."""
    context = session_renderer.gpu.context
    assert context.error == "GL_NO_ERROR"
    yield session_renderer
    assert context.error == "GL_NO_ERROR"
