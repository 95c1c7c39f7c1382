"""How fast one participant may report: far faster than anybody can, and not without end.

All server processes together keep one count, in the database. Asking it at every report would cost
more than it saves, so each process tells it of a lot of them at a time: nobody who takes part fills
many lots, and a flood through several processes is let through for one lot each at the most.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from study.data.limits import REPORTING
from study.data.refusals import TooManyError

LOT: Final = 50
PER_S: Final = REPORTING.per.total_seconds()
MANY: Final = 10_000  # names kept before those whose minute is over are dropped


@dataclass
class Pace:
    """Counts reports by name. ``tell`` adds a lot of them to what all processes count.

    ``tell`` raises TooManyError where that is too many; until it may be tried again this process
    refuses by itself.
    """

    tell: Callable[[str, int], None]
    lot: int = LOT
    per_s: float = PER_S
    clock: Callable[[], float] = time.monotonic
    _untold: dict[str, tuple[float, int]] = field(default_factory=dict)
    _until: dict[str, float] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def check(self, name: str) -> None:
        """Count once for a name; raises TooManyError if that is too fast."""
        if self.count(name):
            self.settle(name)

    def count(self, name: str) -> bool:
        """Count once, without a word to the database; True where a lot is full, to be settled.

        Raises TooManyError while this name is refused.
        """
        now = self.clock()
        with self._lock:
            left_s = self._until.get(name, now) - now
            if left_s > 0:
                raise TooManyError(math.ceil(left_s))
            return self._fills_a_lot(name, now)

    def settle(self, name: str) -> None:
        """Tell of a full lot; raises TooManyError if that was too fast."""
        try:
            self.tell(name, self.lot)
        except TooManyError as error:
            with self._lock:
                self._until[name] = self.clock() + error.wait_s
            raise

    def _fills_a_lot(self, name: str, now: float) -> bool:
        """Count once; a lot that was not filled in time is forgotten."""
        if len(self._untold) + len(self._until) > MANY:
            self._forget(now)
        since, times = self._untold.pop(name, (now, 0))
        if now - since >= self.per_s:
            since, times = now, 0
        if times + 1 >= self.lot:
            return True
        self._untold[name] = (since, times + 1)
        return False

    def _forget(self, now: float) -> None:
        open_lots = self._untold.items()
        self._untold = {name: lot for name, lot in open_lots if now - lot[0] < self.per_s}
        self._until = {name: until for name, until in self._until.items() if until > now}
