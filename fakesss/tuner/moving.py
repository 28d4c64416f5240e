"""How large a picture is drawn while something moves, so that it keeps up with the hand."""

from dataclasses import dataclass

BUDGET_MS = 50.0  # for drawing a frame; with encoding, travel and showing it stays below 100 ms
SCALES = (1, 2, 4)  # whole, half and quarter width and height
WORTH = 0.8  # a smaller picture must take no more than this share of the time, or it only looks worse


@dataclass
class Pace:
    """Which scale to draw at, from how long the last moving and the last still picture took.

    Time is taken to be a + b * samples: the vertices cost the same at every size. Another scale is taken when two
    pictures in a row ask for it: one that something held up is no reason.
    """

    still: tuple[int, float] | None = None  # samples, ms
    moving: tuple[int, float] | None = None
    chosen: int = 1
    asked: int = 1  # the scale that the last picture asked for

    def note(self, moving: bool, samples: int, ms: float) -> None:
        """A picture was drawn."""
        if moving:
            self.moving = samples, ms
        else:
            self.still = samples, ms

    def scale(self, samples: int) -> int:
        """The scale for the next picture, which has `samples` at full size, one a pixel."""
        best = self.best(samples)
        self.chosen, self.asked = best if best == self.asked else self.chosen, best
        return self.chosen

    def best(self, samples: int) -> int:
        """The largest picture that keeps up, or where none does, the smallest that is worth it."""
        fixed, each = self.model()
        chosen = SCALES[0]
        for scale in SCALES[1:]:
            larger, smaller = (fixed + each * samples / side**2 for side in (chosen, scale))
            if larger <= BUDGET_MS or smaller > WORTH * larger:
                break
            chosen = scale
        return chosen

    def model(self) -> tuple[float, float]:
        """a and b, in ms and ms a sample; both 0 while nothing is known."""
        known = self.moving or self.still
        if known is None:
            return 0.0, 0.0
        few, many = sorted((known, self.still or known))
        if many[0] == few[0] or many[1] <= few[1]:  # they do not tell, or one is of a time when the machine was slow
            return 0.0, known[1] / known[0]
        each = min((many[1] - few[1]) / (many[0] - few[0]), few[1] / few[0])
        return few[1] - each * few[0], each
