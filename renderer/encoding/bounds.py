"""What an encoded clip may cost and lose, and how fine it is made so that it holds."""

from __future__ import annotations

import math
from typing import Final

from renderer.clip import ClipSpec
from renderer.encoding.comparison import Fidelity
from renderer.encoding.encode import BOX_STEPS, BUFFER_S, QUALITY

MAX_BYTES: Final = 8_000_000  # of a clip of 5 s with 1920 x 1080 pixels or fewer
REFERENCE_S: Final = 5.0
REFERENCE_PX: Final = 1920 * 1080
MAX_FLIP_SHARE: Final = 0.1
FULL: Final = 0.97  # aim a little below the bound: the file has a head, the buffer is no wall
FILLED: Final = 0.9  # of x264's rate buffer before the first frame
STEPS_PER_OCTAVE: Final = 5.0  # what doubles or halves a clip's file
FINEST_BY: Final = 6.0  # steps; a picture of 720 lines then takes what one of 1080 does

# How much finer the eyes can be than at macroscopic for as many bytes: they are smaller.
FINER: Final = {"macroscopic": 0.0, "near": 4.8, "medium": 9.5, "far": 9.5}


def max_bytes(spec: ClipSpec) -> int:
    """Return how large a clip's file may be: in proportion to its time and, above 1080p, size.

    Less than a second still has a whole key frame and may take as much as a second.
    """
    seconds = max(1.0, spec.duration_s)
    larger = max(1.0, spec.width * spec.height / REFERENCE_PX)
    return round(MAX_BYTES * seconds / REFERENCE_S * larger)


def max_rate(spec: ClipSpec) -> float:
    """Return the rate in bits per second that keeps a clip's file below ``max_bytes``.

    What the full buffer holds at the start comes on top of it.
    """
    seconds = spec.frame_count / spec.fps
    return FULL * 8 * max_bytes(spec) / (seconds + FILLED * BUFFER_S)


def quality(spec: ClipSpec) -> float:
    """Return the constant rate factor outside of the eyes: finer for a smaller picture."""
    octaves = math.log2(REFERENCE_PX / (spec.width * spec.height))
    return QUALITY - min(FINEST_BY, max(0.0, STEPS_PER_OCTAVE * octaves))


def box_steps(spec: ClipSpec) -> float:
    """Return how many steps finer the eyes are, so that a clip nearly fills its bytes."""
    return BOX_STEPS + FINER[spec.distance]


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
