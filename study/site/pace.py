"""How fast one participant may report: far faster than anybody can, and not without end.

Counted in each server process by itself: a question to the database per report would cost more
than it saves.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from study.data.refusals import TooManyError

MOST: Final = 600
PER_S: Final = 60.0
MANY: Final = 10_000  # names kept before those whose minute is over are dropped


@dataclass
class Pace:
    """At most ``most`` times in ``per_s`` seconds for each name."""

    most: int = MOST
    per_s: float = PER_S
    clock: Callable[[], float] = time.monotonic
    _since: dict[str, tuple[float, int]] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def check(self, name: str) -> None:
        """Count once for a name; raises TooManyError if that is too fast."""
        now = self.clock()
        with self._lock:
            since, times = self._since.get(name, (now, 0))
            if now - since >= self.per_s:
                since, times = now, 0
            self._since[name] = (since, times + 1)
            if len(self._since) > MANY:
                self._since = {
                    key: entry for key, entry in self._since.items() if now - entry[0] < self.per_s
                }
        if times >= self.most:
            raise TooManyError(max(1, math.ceil(since + self.per_s - now)))
