"""Hairs as data: where they run, how wide they are, what colour they have. Pure numpy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from renderer.body.makehuman import Floats


@dataclass(frozen=True)
class Strands:
    """Hairs: points (n, k, 3) in mm, width at the root (n,) in mm, linear colour (n, 3).

    ``shadow`` (n,) is what a strand takes from the light of what lies under it: above 0 it is no
    hair but a soft mark on the skin, a shadow where it is black. None means hairs only.
    """

    points_mm: Floats
    width_mm: Floats
    colour: Floats
    shadow: Floats | None = None


def joined(groups: list[Strands]) -> Strands:
    """Return groups of hairs, or groups of marks, as one."""
    shadows = [group.shadow for group in groups if group.shadow is not None]
    return Strands(
        np.concatenate([group.points_mm for group in groups]),
        np.concatenate([group.width_mm for group in groups]),
        np.concatenate([group.colour for group in groups]),
        np.concatenate(shadows) if shadows else None,
    )
