"""Several clips, one after the other: render what is missing, once, and survive being killed.

While a clip is drawn, the one before is compared with its encoding in another process.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import BrokenExecutor, Future
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Self

from renderer.clip import ClipSpec
from renderer.manifest import ClipRecord
from renderer.production.drawing import DrawnClip, FrameSource, Progress
from renderer.production.finishing import Finishing
from renderer.production.folder import bring_in, draw_part, kept_record, remove_parts
from renderer.production.making import finish_clip


def render_clips(
    specs: Iterable[ClipSpec],
    folder: Path,
    *,
    source: FrameSource,
    progress: Callable[[int, float], None] = lambda _number, _share: None,
    with_master: bool = False,
    with_flip: bool = True,
) -> list[ClipRecord]:
    """Render the clips that the folder does not hold yet; return every clip's record.

    ``progress`` hears the clip's number (0-based) and the share of it that is done.
    """
    remove_parts(folder)
    wanted = {spec.clip_id: spec for spec in specs}
    records: dict[str, ClipRecord] = {}
    with _Waiting(folder, records) as waiting:
        for number, (clip_id, spec) in enumerate(wanted.items()):
            kept = kept_record(spec, folder, with_master=with_master)
            if kept is not None:
                records[clip_id] = kept
                progress(number, 1.0)
                continue

            def hear(share: float, number: int = number) -> None:
                waiting.look()
                progress(number, share)

            drawn = draw_part(
                spec,
                folder,
                source=source,
                progress=hear,
                with_master=with_master,
                with_flip=with_flip,
            )
            waiting.take(drawn, is_last=number + 1 == len(wanted))
    if wanted:
        progress(len(wanted) - 1, 1.0)
    return [records[clip_id] for clip_id in wanted]


class _Waiting:
    """The clip that is drawn and not yet finished, at most one, and where its record goes.

    Leaving the block brings it in: what is drawn is not lost by what went wrong later.
    """

    def __init__(self, folder: Path, records: dict[str, ClipRecord]) -> None:
        self._folder = folder
        self._records = records
        self._finishing = Finishing()
        self._last: tuple[DrawnClip, Future[ClipRecord]] | None = None

    def look(self) -> None:
        """Bring the clip in if it is finished."""
        if self._last is not None and self._last[1].done():
            self._bring_in()

    def take(self, drawn: DrawnClip, *, is_last: bool) -> None:
        """Have a clip finished after the one before: elsewhere, unless nothing else is drawn."""
        self._bring_in()
        if is_last:
            self._keep(drawn, partial(finish_clip, drawn))
        else:
            self._last = drawn, self._finishing.start(drawn)

    def _bring_in(self) -> None:
        if self._last is not None:
            (drawn, future), self._last = self._last, None
            self._keep(drawn, partial(_result, future, drawn))

    def _keep(self, drawn: DrawnClip, finished: Callable[[], ClipRecord]) -> None:
        self._records[drawn.spec.clip_id] = bring_in(drawn, self._folder, finished)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            self._bring_in()
        finally:
            self._finishing.close()


def _result(future: Future[ClipRecord], drawn: DrawnClip) -> ClipRecord:
    try:
        return future.result()
    except BrokenExecutor:
        return finish_clip(drawn)  # the process was killed: nothing is lost but time


def render_clip(
    spec: ClipSpec,
    folder: Path,
    *,
    source: FrameSource,
    progress: Progress = lambda _share: None,
    with_master: bool = False,
    with_flip: bool = True,
) -> ClipRecord:
    """Render, encode and check one clip, or return its record when it is there already.

    ``with_master`` keeps its frames beside it without loss: a clip without them is made again.
    """
    kept = kept_record(spec, folder, with_master=with_master)
    if kept is None:
        drawn = draw_part(
            spec,
            folder,
            source=source,
            progress=progress,
            with_master=with_master,
            with_flip=with_flip,
        )
        kept = bring_in(drawn, folder, partial(finish_clip, drawn))
    progress(1.0)
    return kept
