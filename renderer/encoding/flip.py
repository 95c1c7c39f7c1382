"""FLIP (Andersson et al. 2020): how visible the difference of two 8-bit pictures is, per pixel.

The package flip-evaluator is the reference; it is optional, so ask ``is_installed`` first.
"""

from __future__ import annotations

import importlib.util
from typing import Any, Final

import numpy as np
import numpy.typing as npt

Pixels = npt.NDArray[np.uint8]

# FLIP wants to know how large a pixel looks: a 0.7 m wide 4K screen seen from 0.7 m, its default.
PIXELS_PER_DEGREE: Final = 67.02
WHY_NOT: Final = "flip-evaluator is not installed; pip install 'ocularist[certify]'"


def is_installed() -> bool:
    """Say whether FLIP can be measured here."""
    return importlib.util.find_spec("flip_evaluator") is not None


def flip_map(reference: Pixels, test: Pixels) -> npt.NDArray[np.float64]:
    """Return FLIP of two sRGB pictures (height, width, 3) uint8 per pixel, 0 to 1."""
    import flip_evaluator

    pair = [np.ascontiguousarray(p, np.float32) / 255 for p in (reference, test)]
    settings: dict[str, Any] = {"parameters": {"ppd": PIXELS_PER_DEGREE}, "applyMagma": False}
    found, _, _ = flip_evaluator.evaluate(*pair, "LDR", **settings)
    return np.asarray(found, dtype=np.float64).reshape(reference.shape[:2])
