"""What rounds of samples add up to, how sure it is, and where it is kept between sessions."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fakesss import cache
from fakesss.offline.settings import noise_of

Floats = NDArray[np.float64]

LATEST = "latest.npz"


@dataclass(frozen=True)
class Tally:
    """Independent rounds of one picture, added up. Frozen: an interruption finds it before a round or after it."""

    total: Floats  # (H, W, 3), sum of the rounds' radiances
    squares: Floats  # (H, W, 3), sum of their squares
    ratios: tuple[float, ...] = ()  # after each round, see `ratio`
    seconds: float = 0.0  # all sessions together

    @classmethod
    def empty(cls, size: tuple[int, int]) -> "Tally":
        """No rounds yet, of a picture of `size` (width, height)."""
        shape = (size[1], size[0], 3)
        return cls(np.zeros(shape), np.zeros(shape))

    @property
    def rounds(self) -> int:
        """How many were added."""
        return len(self.ratios)

    @property
    def mean(self) -> Floats:
        """Radiance (H, W, 3)."""
        return self.total / self.rounds

    @property
    def standard_error(self) -> Floats:
        """Of the mean, (H, W, 3), from the spread of the rounds; infinite after one."""
        return standard_error(self.total, self.squares, self.rounds)

    @property
    def noise(self) -> float:
        """Of the picture so far, see `noise_of`."""
        return noise_of(self.ratios[-1])

    def added(self, radiance: Floats, covered: NDArray[np.bool_], seconds: float) -> "Tally":
        """With one round more, (H, W, 3), which took so long; `covered` (H, W) are the pixels whose noise counts."""
        total, squares, rounds = self.total + radiance, self.squares + radiance**2, self.rounds + 1
        found = ratio(total[covered] / rounds, standard_error(total, squares, rounds)[covered])
        return Tally(total, squares, (*self.ratios, found), self.seconds + seconds)


def standard_error(total: Floats, squares: Floats, rounds: int) -> Floats:
    """Of the mean of `rounds` that add up to `total` and, squared, to `squares`; infinite of one."""
    if rounds < 2:
        return np.full_like(total, np.inf)
    spread = np.maximum(squares / rounds - (total / rounds) ** 2, 0)
    return np.asarray(np.sqrt(spread / (rounds - 1)))


def ratio(radiance: Floats, standard_error: Floats) -> float:
    """RMS of the standard error over that of the radiance as it is, grain and all; infinite while all is black."""
    power = float((radiance**2).sum())
    return float(np.sqrt((standard_error**2).sum() / power)) if power > 0 else float("inf")


@dataclass(frozen=True)
class Shelf:
    """A folder of tallies of one picture: the latest, and the finished ones by their number of rounds."""

    folder: Path
    size: tuple[int, int]  # width, height

    def tallies(self) -> list[Tally]:
        """Every one that can be read."""
        found = (self._read(path) for path in sorted(self.folder.glob("*.npz")))
        return [tally for tally in found if tally.rounds]

    def keep(self, tally: Tally, finished: bool) -> None:
        """Put a tally in its place, whole or not at all; a folder that cannot be written costs only time.

        The latest gives way to a fuller one only: that of a long job stays while a short one is traced.
        """
        latest = self.folder / LATEST
        fullest = self._read(latest).rounds <= tally.rounds
        if not tally.rounds or not (finished or fullest):
            return
        arrays = {"total": tally.total, "squares": tally.squares}
        arrays |= {"noises": np.array(tally.ratios), "seconds": np.array(tally.seconds)}
        try:
            cache.write(self.folder / f"{tally.rounds:06}.npz" if finished else latest, arrays)
            if finished and fullest:
                latest.unlink(missing_ok=True)
        except OSError as error:
            cache.warn_of(cache.folder(), str(error.strerror))

    def _read(self, path: Path) -> Tally:
        """The tally in a file; an empty one if there is none or it is damaged."""
        shape = (self.size[1], self.size[0], 3)
        found = cache.read(path, {"total": shape, "squares": shape, "noises": ("rounds",), "seconds": ()})
        if found is None:
            return Tally.empty(self.size)
        ratios = tuple(float(value) for value in found["noises"])
        return Tally(found["total"], found["squares"], ratios, float(found["seconds"]))
