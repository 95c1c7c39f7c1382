"""What an encoded clip may cost and lose, and which quality to try next when it does not hold."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from renderer.clip import ClipSpec
from renderer.encoding.comparison import Fidelity

MAX_BYTES: Final = 8_000_000  # of a clip of 5 s with 1920 x 1080 pixels or fewer
REFERENCE_S: Final = 5.0
REFERENCE_PX: Final = 1920 * 1080
MAX_FLIP_SHARE: Final = 0.1
STEPS_PER_OCTAVE: Final = 5.0  # what doubled or halved a macroscopic clip's file; noise needs 11
FULL: Final = 0.95  # aim a little below the bound
FINEST: Final = 8.0
COARSEST: Final = 50.0
LONGEST_STEP: Final = 12.0
LEAST_STEP: Final = 0.5
WORTHWHILE: Final = 1.0  # less finer is not worth encoding again


@dataclass(frozen=True)
class Attempt:
    """One encoding of a clip, its quality as x264's constant rate factor: less is better."""

    quality: float
    file_bytes: int
    fidelity: Fidelity


def max_bytes(spec: ClipSpec) -> int:
    """Return how large a clip's file may be: in proportion to its time and, above 1080p, size.

    Less than a second still has a whole key frame and may take as much as a second.
    """
    seconds = max(1.0, spec.duration_s)
    larger = max(1.0, spec.width * spec.height / REFERENCE_PX)
    return round(MAX_BYTES * seconds / REFERENCE_S * larger)


def missed_bounds(attempt: Attempt, *, limit: int) -> list[str]:
    """Return a sentence for each bound that does not hold: found and accepted."""
    missed = []
    if attempt.file_bytes > limit:
        missed.append(
            f"the file has {attempt.file_bytes / 1e6:.2f} MB; at most {limit / 1e6:.2f} MB "
            "are accepted"
        )
    share = attempt.fidelity.flip_share
    if share is not None and share > MAX_FLIP_SHARE:
        missed.append(
            f"FLIP of the encoding is {share:.3f} of FLIP between its LoDs; "
            f"at most {MAX_FLIP_SHARE} is accepted"
        )
    return missed


def next_quality(tried: Sequence[Attempt], *, limit: int) -> float | None:
    """Return the quality to try after some attempts, None where no other can do better."""
    last = tried[-1]
    to_bound = _steps_per_octave(tried) * math.log2(last.file_bytes / (FULL * limit))
    share = last.fidelity.flip_share
    if last.file_bytes > limit:
        wanted = min(COARSEST, last.quality + max(LEAST_STEP, to_bound))
    elif share is not None and share > MAX_FLIP_SHARE:
        wanted = max(FINEST, last.quality - min(LONGEST_STEP, -to_bound))
        return wanted if wanted <= last.quality - WORTHWHILE else None
    else:
        return None
    return wanted if wanted > last.quality else None


def _steps_per_octave(tried: Sequence[Attempt]) -> float:
    """Return how many steps of quality double or halve a file, from the last two attempts."""
    if len(tried) < 2 or tried[-1].file_bytes == tried[-2].file_bytes:
        return STEPS_PER_OCTAVE
    steps = tried[-1].quality - tried[-2].quality
    found = steps / math.log2(tried[-2].file_bytes / tried[-1].file_bytes)
    return min(max(found, STEPS_PER_OCTAVE / 2), 3 * STEPS_PER_OCTAVE)


def better(one: Attempt, other: Attempt, *, limit: int) -> Attempt:
    """Return the better attempt: within the bound on size, then the one that lost less."""
    return min(one, other, key=lambda attempt: _rank(attempt, limit))


def _rank(attempt: Attempt, limit: int) -> tuple[int, float]:
    if attempt.file_bytes > limit:
        return attempt.file_bytes, 0.0
    return 0, attempt.quality
