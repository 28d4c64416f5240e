"""GET /health: whether a rating could be brought to disk now. Anybody may ask, so asking costs little."""

import math
import threading
import time
from dataclasses import dataclass, field

from study_server.storage.database import Database, is_writable

REMEMBERED_S = 1.0
"""How long the database is believed to be well: however often this is asked, it is written to once in so long."""


@dataclass
class Health:
    """When the database was last seen to take a row. That it does not is never remembered."""

    well_until: float = -math.inf
    lock: threading.Lock = field(default_factory=threading.Lock)

    def is_well(self, database: Database) -> bool:
        """Whether a row can be brought to disk, or could within the last second and nothing failed since."""
        with self.lock:
            now = time.monotonic()
            if now >= self.well_until:
                self.well_until = now + REMEMBERED_S
                if not is_writable(database):
                    self.well_until = -math.inf
            return now < self.well_until

    def doubt(self) -> None:
        """Something was not saved just now: the next one who asks is told what is so then."""
        self.well_until = -math.inf
