"""A few recently made things, kept for the next picture of a sweep."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

Made = TypeVar("Made")


class Recent(Generic[Made]):
    """The `limit` most recently used values; `dispose` is called on each that drops out, before a new one is made.

    So there is never more than `limit` of them in memory at once.
    """

    def __init__(self, limit: int, dispose: Callable[[Made], object] = lambda value: None) -> None:
        self.limit, self.dispose = limit, dispose
        self.values: OrderedDict[Hashable, Made] = OrderedDict()

    def __contains__(self, key: Hashable) -> bool:
        return key in self.values

    def get(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """The value of `key`, made now if it is not at hand."""
        if key not in self.values:
            while len(self.values) >= self.limit:
                self.dispose(self.values.popitem(last=False)[1])
            self.values[key] = make()
        self.values.move_to_end(key)
        return self.values[key]

    def clear(self) -> None:
        """Dispose of everything."""
        while self.values:
            self.dispose(self.values.popitem()[1])
