"""A clip is encoded while it is rendered, and again from its master where a bound does not hold."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from renderer.clip import ClipSpec
from renderer.encoding.bounds import Attempt, better, max_bytes, next_quality
from renderer.encoding.comparison import Comparison
from renderer.encoding.encode import QUALITY, encode_again
from renderer.encoding.eye_boxes import eye_boxes

MAX_ATTEMPTS: Final = 3  # each takes about a third of the time of rendering


def settle(path: Path, master: Path, *, spec: ClipSpec, comparison: Comparison) -> Attempt:
    """Return the best encoding of a clip, which then lies at ``path``.

    ``path`` has been encoded at QUALITY, ``master`` has its frames without loss.
    """
    limit, boxes = max_bytes(spec), eye_boxes(spec)
    best = attempt = _measure(path, QUALITY, comparison)
    tried = [attempt]
    again = path.with_suffix(".again.mp4")
    for _ in range(MAX_ATTEMPTS - 1):
        quality = next_quality(tried, limit=limit)
        if quality is None:
            break
        try:
            encode_again(master, again, boxes=boxes, quality=quality)
            attempt = _measure(again, quality, comparison)
            tried.append(attempt)
            if better(best, attempt, limit=limit) is attempt:
                again.replace(path)
                best = attempt
        finally:
            again.unlink(missing_ok=True)
    return best


def _measure(path: Path, quality: float, comparison: Comparison) -> Attempt:
    return Attempt(quality, path.stat().st_size, comparison.compare(path))
