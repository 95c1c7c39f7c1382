"""Colours and patterns by which a screen is tested: the self-test clip's, and the two strips.

Pure. The clip shows PATCHES as flat squares; the strips show steps close to black and to white.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import Final, Literal

import numpy as np

Rgb = tuple[int, int, int]
Strip = Literal["dark", "light"]

# Greys, then what eyes are made of: irises, sclera, vessels, skin. Blue far from its luma is left
# out: Chromium without a GPU cannot show it (docs/encoding.md).
PATCHES: Final[tuple[Rgb, ...]] = (
    *((0, 0, 0), (16, 16, 16), (64, 64, 64), (128, 128, 128), (192, 192, 192), (255, 255, 255)),
    *((78, 108, 140), (90, 60, 32), (92, 110, 74), (214, 202, 192), (150, 60, 56), (196, 142, 116)),
)
PATCH_PX: Final = 48  # the side of a square
COLUMNS: Final = 6
CLIP_FPS: Final = 30
CLIP_FRAMES: Final = 15


def self_test_name() -> str:
    """Return the file name of the clip that shows PATCHES; another clip has another name."""
    told = f"{PATCHES} {PATCH_PX} {COLUMNS} {CLIP_FPS} {CLIP_FRAMES}"
    return f"self-test-{hashlib.sha256(told.encode()).hexdigest()[:12]}.mp4"


STEPS: Final = (3, 6, 10, 15, 22)
"""How far from black or white the squares of a strip lie, in steps of 255."""
PLAIN_STEPS: Final = (110, 140, 170)
"""Squares that everybody sees: 1 to 3 of them, so that the number to count cannot be guessed."""
LEAST_SEEN: Final = 3


def colour_error(shown: Sequence[Sequence[float]]) -> float | None:
    """Return the largest difference between a patch and what a browser shows of it.

    None where the browser does not show as many patches as there are.
    """
    if len(shown) != len(PATCHES):
        return None
    return round(float(np.abs(np.array(shown) - np.array(PATCHES)).max()), 2)


def strip_levels(seed: int, strip: Strip) -> tuple[int, ...]:
    """Return the grey levels of a strip's squares from left to right, 0 to 255."""
    rng = np.random.default_rng([seed, 0x57E9, strip == "dark"])
    plain = PLAIN_STEPS[: int(rng.integers(1, len(PLAIN_STEPS) + 1))]
    steps = rng.permutation([*STEPS, *plain])
    return tuple(int(step) if strip == "dark" else 255 - int(step) for step in steps)


def steps_seen(counted: int | None, seed: int, strip: Strip) -> int | None:
    """Return how many of a strip's close squares somebody saw who counted so many, 0 to 5.

    Whoever counts fewer than the plain ones, or more than there are, has not counted: 0.
    """
    if counted is None:
        return None
    seen = counted - (len(strip_levels(seed, strip)) - len(STEPS))
    return seen if 0 <= seen <= len(STEPS) else 0
