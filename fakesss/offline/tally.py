"""What rounds of samples add up to, how sure it is, and where it is kept between sessions."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fakesss import cache

Floats = NDArray[np.float64]

LATEST = "latest.npz"


@dataclass
class Tally:
    """Independent rounds of one picture, added up."""

    total: Floats  # (H, W, 3), sum of the rounds' radiances
    squares: Floats  # (H, W, 3), sum of their squares
    noises: list[float] = field(default_factory=list)  # after each round, see `noise`
    seconds: float = 0.0  # all sessions together

    @classmethod
    def empty(cls, size: tuple[int, int]) -> "Tally":
        """No rounds yet, of a picture of `size` (width, height)."""
        shape = (size[1], size[0], 3)
        return cls(np.zeros(shape), np.zeros(shape))

    @property
    def rounds(self) -> int:
        """How many were added."""
        return len(self.noises)

    @property
    def mean(self) -> Floats:
        """Radiance (H, W, 3)."""
        return self.total / self.rounds

    @property
    def standard_error(self) -> Floats:
        """Of the mean, (H, W, 3), from the spread of the rounds; infinite after one."""
        if self.rounds < 2:
            return np.full_like(self.total, np.inf)
        spread = np.maximum(self.squares / self.rounds - self.mean**2, 0)
        return np.asarray(np.sqrt(spread / (self.rounds - 1)))

    def add(self, radiance: Floats, covered: NDArray[np.bool_], seconds: float) -> None:
        """One round more, (H, W, 3), which took so long; `covered` (H, W) are the pixels whose noise counts."""
        self.total += radiance
        self.squares += radiance**2
        self.seconds += seconds
        self.noises.append(0.0)  # a round more, whose noise is not known yet
        self.noises[-1] = noise(self.mean[covered], self.standard_error[covered])


def noise(radiance: Floats, standard_error: Floats) -> float:
    """Root mean square of the standard error over that of the radiance, all channels together; 0 where all is black."""
    signal = float((radiance**2).sum())
    return float(np.sqrt((standard_error**2).sum() / signal)) if signal > 0 else 0.0


@dataclass(frozen=True)
class Shelf:
    """A folder of tallies of one picture: the latest, and the finished ones by their number of rounds."""

    folder: Path
    size: tuple[int, int]  # width, height

    def tallies(self) -> Iterator[Tally]:
        """Every one that can be read."""
        shape = (self.size[1], self.size[0], 3)
        for path in sorted(self.folder.glob("*.npz")):
            found = cache.read(path, {"total": shape, "squares": shape, "noises": ("rounds",), "seconds": ()})
            if found is not None and len(found["noises"]):
                noises = [float(value) for value in found["noises"]]
                yield Tally(found["total"], found["squares"], noises, float(found["seconds"]))

    def keep(self, tally: Tally, finished: bool) -> None:
        """Put a tally in its place, whole or not at all; a folder that cannot be written costs only time."""
        arrays = {"total": tally.total, "squares": tally.squares}
        arrays |= {"noises": np.array(tally.noises), "seconds": np.array(tally.seconds)}
        try:
            cache.write(self.folder / (f"{tally.rounds:06}.npz" if finished else LATEST), arrays)
            if finished:
                (self.folder / LATEST).unlink(missing_ok=True)
        except OSError as error:
            cache.warn_of(cache.folder(), str(error.strerror))
