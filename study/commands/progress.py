"""Progress in the terminal: one bar in clips, moving with every frame, with the time left."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from tqdm import tqdm


class ClipBar:
    """A bar over ``total`` clips; where nobody watches (no terminal) one line per clip instead."""

    def __init__(self, total: int, *, title: str = "Rendering") -> None:
        from tqdm import tqdm

        self._title = title
        self._total = total
        self._told = 0
        self._began: tuple[float, float] | None = None
        self._bar: tqdm[Any] = tqdm(
            total=total,
            bar_format=f"{title} {{bar}} {{desc}}",
            disable=not sys.stderr.isatty(),
            leave=False,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def show(self, done: float, *, left_s: float | None = None) -> None:
        """Move the bar to ``done`` clips; 2.5 means half of the third.

        Without ``left_s`` the time left is reckoned from how fast the bar has moved so far.
        """
        now = time.monotonic()
        if self._began is None:
            self._began = (now, done)
        if left_s is None and done > self._began[1]:
            per_clip_s = (now - self._began[0]) / (done - self._began[1])
            left_s = per_clip_s * (self._total - done)
        count = f"{done:.1f}".removesuffix(".0")
        state = f"{count} of {self._total} clips" + time_left(left_s)
        if not self._bar.disable:
            self._bar.n = min(done, self._total)
            self._bar.set_description_str(state)
        elif int(done) > self._told:
            self._told = int(done)
            print(f"{self._title}: {state}", file=sys.stderr, flush=True)

    def clear(self) -> None:
        """Take the bar off the screen until it moves again."""
        self._bar.clear()

    def close(self) -> None:
        """Take the bar off the screen for good."""
        self._bar.close()


def time_left(left_s: float | None) -> str:
    """Return ``, about 3 min left``; nothing while there is no telling."""
    if left_s is None:
        return ""
    if left_s < 90:
        return f", about {max(1, round(left_s / 5)) * 5} s left"
    if left_s < 90 * 60:
        return f", about {round(left_s / 60)} min left"
    return f", about {left_s / 3600:.1f} h left"
