"""Progress in the terminal: one bar in clips, moving with every frame, with the time left."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from tqdm import tqdm

BAR_FORMAT = "{desc} {bar} {n:.1f} of {total} clips, {remaining} left"


class ClipBar:
    """A bar over ``total`` clips; where nobody watches (no terminal) one line per clip instead."""

    def __init__(self, total: int, *, title: str = "Rendering") -> None:
        from tqdm import tqdm

        self._title = title
        self._total = total
        self._finished = 0
        self._bar: tqdm[Any] = tqdm(
            total=total,
            desc=title,
            bar_format=BAR_FORMAT,
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
        self._bar.close()

    def show(self, done: float) -> None:
        """Move the bar to ``done`` clips; 2.5 means half of the third."""
        self._bar.n = min(done, self._total)
        self._bar.refresh()
        if int(done) > self._finished:
            self._finished = int(done)
            if self._bar.disable:
                print(f"{self._title}: {self._finished} of {self._total} clips", flush=True)
