"""The colours of an iris: seven families as data, and how tone and pigment make an albedo.

Anchors are artist values in sRGB (reference/eye-rendering.md, 1.5), everything else is linear
Rec. 709. A single scalar, melanin, both colours the surface and thickens its pigmented sheet.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float32]
Rgb = tuple[int, int, int]


@dataclass(frozen=True)
class Family:
    """One colour family.

    ``stops`` are sRGB colours at the pupil's edge, the middle of the pupillary zone, the
    collarette, the middle and outer ciliary zone and the rim. ``core`` is a second pigment
    around the pupil (central heterochromia) of share ``core_share`` reaching ``core_mm`` from the
    pupil. ``veil`` is how far a continuous pigmented sheet hides the fibres; ``contrast`` scales
    the luminance between crest and gap; ``freckles`` and ``crypts`` are mean rates.
    """

    stops: tuple[Rgb, Rgb, Rgb, Rgb, Rgb, Rgb]
    core: Rgb
    core_share: float
    core_mm: float
    pigment: Rgb
    veil: float
    contrast: float
    pallor: float
    freckles: float
    crypts: float


FAMILIES: Final[Mapping[str, Family]] = MappingProxyType(
    {
        "blue": Family(
            stops=(
                (118, 122, 116),
                (124, 138, 146),
                (130, 148, 164),
                (98, 125, 153),
                (86, 112, 142),
                (47, 60, 80),
            ),
            core=(158, 132, 86),
            core_share=0.24,
            core_mm=0.8,
            pigment=(94, 68, 42),
            veil=0.08,
            contrast=1.14,
            pallor=0.20,
            freckles=0.8,
            crypts=1.0,
        ),
        "grey": Family(
            stops=(
                (122, 118, 104),
                (132, 134, 128),
                (160, 166, 168),
                (132, 141, 147),
                (114, 123, 130),
                (56, 64, 74),
            ),
            core=(142, 122, 86),
            core_share=0.30,
            core_mm=0.7,
            pigment=(94, 70, 46),
            veil=0.08,
            contrast=0.98,
            pallor=0.22,
            freckles=0.8,
            crypts=1.0,
        ),
        "green": Family(
            stops=(
                (122, 104, 62),
                (122, 112, 72),
                (120, 122, 88),
                (102, 114, 88),
                (88, 101, 80),
                (46, 55, 48),
            ),
            core=(132, 102, 58),
            core_share=0.5,
            core_mm=1.1,
            pigment=(92, 62, 32),
            veil=0.14,
            contrast=1.22,
            pallor=0.12,
            freckles=1.4,
            crypts=0.9,
        ),
        "hazel": Family(
            stops=(
                (118, 84, 46),
                (124, 92, 52),
                (122, 101, 62),
                (102, 100, 72),
                (90, 92, 68),
                (50, 50, 40),
            ),
            core=(124, 86, 46),
            core_share=0.65,
            core_mm=1.5,
            pigment=(84, 52, 26),
            veil=0.25,
            contrast=1.25,
            pallor=0.1,
            freckles=2.2,
            crypts=0.85,
        ),
        "amber": Family(
            stops=(
                (112, 78, 40),
                (126, 90, 48),
                (144, 108, 62),
                (130, 96, 54),
                (112, 81, 45),
                (66, 44, 24),
            ),
            core=(122, 78, 36),
            core_share=0.45,
            core_mm=1.2,
            pigment=(112, 62, 24),
            veil=0.30,
            contrast=1.3,
            pallor=0.12,
            freckles=1.5,
            crypts=0.8,
        ),
        "brown": Family(
            stops=(
                (84, 54, 34),
                (94, 63, 42),
                (112, 80, 56),
                (88, 61, 42),
                (74, 51, 36),
                (42, 28, 20),
            ),
            core=(102, 68, 40),
            core_share=0.45,
            core_mm=1.3,
            pigment=(58, 34, 20),
            veil=0.50,
            contrast=1.55,
            pallor=0.05,
            freckles=1.2,
            crypts=0.7,
        ),
        "dark-brown": Family(
            stops=(
                (52, 34, 24),
                (60, 39, 28),
                (72, 49, 36),
                (57, 38, 28),
                (48, 32, 24),
                (28, 20, 15),
            ),
            core=(70, 44, 27),
            core_share=0.40,
            core_mm=1.3,
            pigment=(34, 22, 15),
            veil=0.62,
            contrast=1.95,
            pallor=0.04,
            freckles=0.6,
            crypts=0.6,
        ),
    }
)

# Bare pigment epithelium behind the pupil and at the ruff: "near black in every eye"
# (Baranoski and Lam 2007, after reference/eye-rendering.md, 1.5).
IPE_ALBEDO: Final = (0.004, 0.003, 0.0025)
RUFF: Final[Rgb] = (62, 40, 26)


def family(colour: str) -> Family:
    """Return the record of a colour family; raises ValueError naming those that exist."""
    if colour not in FAMILIES:
        raise ValueError(f'iris colour: unknown "{colour}"; choose one of {", ".join(FAMILIES)}')
    return FAMILIES[colour]
