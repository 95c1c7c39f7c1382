"""What an encoded clip may cost and lose, and how fine it is made so that it holds."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

from renderer.clip import ClipSpec
from renderer.encoding.comparison import Fidelity
from renderer.encoding.encode import Rate

MAX_BYTES: Final = 8_000_000  # of a clip of 5 s with 1920 x 1080 pixels or fewer
REFERENCE_S: Final = 5.0
REFERENCE_PX: Final = 1920 * 1080
MAX_FLIP_SHARE: Final = 0.1
FULL: Final = 0.985  # aim a little below the bound: the file has a head, the buffer is no wall
# A player has the whole clip before it starts, so what the sides of an orbit leave over may go to
# its middle: x264's rate buffer holds a large part of a clip, which H.264's level 4 allows (31
# Mbit). It begins nine tenths full, and x264 keeps it half full as long as it looks ahead. A clip
# that is hardly longer than it looks ahead (2 s) empties it, so that has a small one.
LONG_S: Final = 4.0
BUFFER_S: Final = {True: 3.0, False: 0.5}  # by whether a clip is long
DRAINED: Final = {True: 0.4, False: 0.9}
STEPS_PER_OCTAVE: Final = 5.0  # what doubles or halves a clip's file
FINEST_BY: Final = 6.0  # steps; a picture of 720 lines then takes what one of 1080 does


@dataclass(frozen=True, kw_only=True)
class Fineness:
    """How fine a distance's clips are made: x264's constant rate factor outside of the eyes' boxes,
    how many steps finer the lids' opening and the lids are (6 halve the error), and the matrices.

    H.264's own matrices (jvt) spare what FLIP sees least; where so fine a quantiser has no step
    left to give, flat ones go further. More steps than the factor has are no waste: x264 is coarser
    by several where there is much detail.
    """

    quality: float
    eye_steps: float
    lid_steps: float
    matrices: str = "flat"


FINENESS: Final = {
    "macroscopic": Fineness(quality=26.0, eye_steps=21.7, lid_steps=0.0, matrices="jvt"),
    "near": Fineness(quality=24.0, eye_steps=20.0, lid_steps=6.0),
    "medium": Fineness(quality=24.0, eye_steps=32.0, lid_steps=8.0),
    "far": Fineness(quality=24.0, eye_steps=32.0, lid_steps=8.0),
}


def max_bytes(spec: ClipSpec) -> int:
    """Return how large a clip's file may be: in proportion to its time and, above 1080p, size.

    Less than a second still has a whole key frame and may take as much as a second.
    """
    seconds = max(1.0, spec.duration_s)
    larger = max(1.0, spec.width * spec.height / REFERENCE_PX)
    return round(MAX_BYTES * seconds / REFERENCE_S * larger)


def max_rate(spec: ClipSpec) -> Rate:
    """Return the rate that keeps a clip's file below ``max_bytes``.

    What is taken out of the buffer comes on top of it.
    """
    seconds = spec.frame_count / spec.fps
    is_long = seconds >= LONG_S
    drained_s = DRAINED[is_long] * BUFFER_S[is_long]
    return Rate(FULL * 8 * max_bytes(spec) / (seconds + drained_s), BUFFER_S[is_long])


def fineness(spec: ClipSpec) -> Fineness:
    """Return how fine a clip is made: a smaller picture is finer and fills its bytes, too."""
    octaves = math.log2(REFERENCE_PX / (spec.width * spec.height))
    finer = min(FINEST_BY, max(0.0, STEPS_PER_OCTAVE * octaves))
    found = FINENESS[spec.distance]
    return replace(found, quality=found.quality - finer)


def missed_bounds(file_bytes: int, fidelity: Fidelity, *, limit: int) -> list[str]:
    """Return a sentence for each bound that does not hold: found and accepted."""
    missed = []
    if file_bytes > limit:
        missed.append(
            f"the file has {file_bytes / 1e6:.2f} MB; at most {limit / 1e6:.2f} MB are accepted"
        )
    share, floor = fidelity.flip_share, fidelity.flip_floor
    if share is not None and share > MAX_FLIP_SHARE:
        known = "" if floor is None else f"; 8 bits of 4:2:0 alone, uncompressed, have {floor:.3f}"
        missed.append(
            f"FLIP of the encoding is {share:.3f} of FLIP between its LoDs; "
            f"at most {MAX_FLIP_SHARE} is accepted{known}"
        )
    return missed
