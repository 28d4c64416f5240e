"""Linear algebra on one core, whatever the machine has: sums of several threads differ in their last digits."""

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

P = ParamSpec("P")
R = TypeVar("R")


def on_one_core(function: Callable[P, R]) -> Callable[P, R]:
    """`function` with one thread in every numeric library that is loaded; as many as before when it has returned.

    So equal input gives equal bytes on any machine of one kind; matrices of ratings are too small to gain by more.
    """

    @wraps(function)
    def limited(*args: P.args, **named: P.kwargs) -> R:
        with threadpool_limits(limits=1):
            return function(*args, **named)

    return limited
