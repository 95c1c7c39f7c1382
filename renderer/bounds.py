"""What an encoded clip may cost and lose, and which quality to try next when it does not hold."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from renderer.clip import ClipSpec
from renderer.comparison import Fidelity

MAX_BYTES: Final = 8_000_000  # of a clip of 5 s with 1920 x 1080 pixels or fewer
REFERENCE_S: Final = 5.0
REFERENCE_PX: Final = 1920 * 1080
MAX_FLIP_SHARE: Final = 0.1
STEPS_PER_OCTAVE: Final = 6.0  # x264: six steps of its quality double or halve a file, about
FULL: Final = 0.97  # a file this near to its bound is as good as it can be
FINEST: Final = 8.0
COARSEST: Final = 50.0
LONGEST_STEP: Final = 8.0
LEAST_STEP: Final = 0.5  # less is not worth encoding again


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


def next_quality(attempt: Attempt, *, limit: int) -> float | None:
    """Return the quality to try after an attempt, None where no other can do better."""
    octaves = math.log2(attempt.file_bytes / (FULL * limit))
    share = attempt.fidelity.flip_share
    if attempt.file_bytes > limit:
        wanted = min(COARSEST, attempt.quality + max(0.5, STEPS_PER_OCTAVE * octaves))
    elif share is not None and share > MAX_FLIP_SHARE:
        finer = min(LONGEST_STEP, -STEPS_PER_OCTAVE * octaves)
        wanted = max(FINEST, attempt.quality - max(0.0, finer))
    else:
        return None
    return None if abs(wanted - attempt.quality) < LEAST_STEP else wanted


def better(one: Attempt, other: Attempt, *, limit: int) -> Attempt:
    """Return the better attempt: within the bound on size, then the one that lost less."""
    return min(one, other, key=lambda attempt: _rank(attempt, limit))


def _rank(attempt: Attempt, limit: int) -> tuple[int, float]:
    if attempt.file_bytes > limit:
        return attempt.file_bytes, 0.0
    return 0, attempt.quality
