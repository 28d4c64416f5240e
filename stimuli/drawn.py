"""What every way of making a picture ends in: its bytes, its cues, and what is to be said of it."""

from dataclasses import dataclass
from typing import Any

from stimuli.cues import Cues
from stimuli.manifest import sha256


@dataclass(frozen=True)
class Drawn:
    """A picture's PNG bytes, its image cues, and what is to be said of it.

    `origin`: where a picture of other origin comes from; None: our renderer drew it.
    """

    png: bytes
    width: int
    height: int
    passes: tuple[str, ...]
    warnings: tuple[str, ...]
    cues: Cues
    origin: dict[str, Any] | None = None

    def facts(self) -> dict[str, Any]:
        """The picture's side of its manifest entry."""
        return {
            "sha256": sha256(self.png),
            "width": self.width,
            "height": self.height,
            "passes": list(self.passes),
            "warnings": list(self.warnings),
            "origin": self.origin,
            **self.cues.facts(),
        }
