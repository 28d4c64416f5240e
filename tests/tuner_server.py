"""The tuner on a real socket, for tests in Python and in browsers."""

from fakesss.tuner.serve import tuned

__all__ = ["tuned"]
