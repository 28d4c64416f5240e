"""A GL error left behind by one test must not be found by another."""

from collections.abc import Iterator

import pytest

from fakesss.gpu import Gpu, shared
from fakesss.renderer import Renderer, shared_renderer


@pytest.fixture
def gpu() -> Iterator[Gpu]:
    """The context, with no OpenGL error before and none after the test."""
    gpu = shared()
    assert gpu.context.error == "GL_NO_ERROR"
    yield gpu
    assert gpu.context.error == "GL_NO_ERROR"


@pytest.fixture
def renderer(gpu: Gpu) -> Renderer:
    return shared_renderer()
