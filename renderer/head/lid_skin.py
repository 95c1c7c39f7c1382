"""The skin of the lids as rings around the fissure: lashes' edge, tarsal platform, crease, fold.

Pure numpy, patch space (see ``lid_pose``). Near the rim the skin lies on the globe's hull, further
out on the face. When the upper lid sinks its skin unfolds from the crease, which hardly moves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.head.lid_pose import LidPose
from renderer.head.lid_rims import smooth_step, soft_max
from renderer.head.lid_shell import on_hull

THICKNESS_MM: Final = (1.75, 2.25)  # of the lid over the globe: at its edge, and from 4 mm on
UNFOLDED: Final = 0.85  # share of the rim's way that skin from the crease supplies
LEAST_PLATFORM_MM: Final = 0.9  # of skin below the crease that stays in sight in upgaze
FOLD_MM: Final = 1.9  # how far the upper lid's fold stands out over the crease
FOLD_FADES_MM: Final = 4.5  # of the lid's way down, over which the fold is drawn smooth
FULLNESS_MM: Final = 1.2  # of the soft tissue between the fold and the brow
TEMPLE_SLOPE: Final = 0.55
BRIDGE_SAG_MM: Final = 0.5  # of the skin from the lower lid straight to the cheek
OUTER_SHARES: Final = (0.12, 0.27, 0.44, 0.61, 0.77, 0.9)  # rings between the fold and the outline


@dataclass(frozen=True)
class Columns:
    """What the skin's profile depends on, column by column around the fissure.

    ``edge`` (n, 3) the lids' outer edge; ``outward`` (n, 2) where rings grow; ``canthus`` (n,)
    nearness to a corner; ``lowered_mm`` (n,) how far the rim has sunk; ``end_mm`` (n,) how far
    the outline is; ``face`` returns the height of the face's skin at points (..., 2).
    """

    edge: Floats
    outward: Floats
    canthus: Floats
    lowered_mm: Floats
    end_mm: Floats
    pose: LidPose
    face: Callable[[Floats], Floats]

    def at(self, distance: Floats) -> Floats:
        """Return the frontal places (n, 2) at distances (n,) in mm from the edge."""
        return np.asarray(self.edge[:, :2] + self.outward * distance[:, None])

    def on_lid(self, distance: Floats) -> tuple[Floats, Floats]:
        """Return places (n, 2) and the height (n,) of skin that follows the globe from the edge.

        At the canthi, off the globe, it runs on level.
        """
        xy = self.at(distance)
        thin, full = THICKNESS_MM
        thick = thin + (full - thin) * smooth_step(distance / 4.0)
        start = on_hull(self.edge[:, :2], self.pose, lift=thin)
        globe = on_hull(xy, self.pose, lift=thick)
        offset = (self.edge[:, 2] - start) * np.exp(-distance / 1.5)
        # At the outer corner the face falls away to the temple.
        temple = smooth_step((self.edge[:, 0] - 4.0) / 7.0)
        level = self.edge[:, 2] - temple * TEMPLE_SLOPE * np.maximum(distance - 1.0, 0.0)
        # Beside the globe the hull is a wall: skin does not go down there, least towards the nose.
        nose = smooth_step((-self.edge[:, 0] - 3.0) / 7.0)
        floor = level - (1.0 - 0.8 * nose) - (0.45 * (1 - temple) - 0.40 * nose) * distance
        globe = soft_max(globe + offset, floor, 2.0 - 1.2 * nose)
        return xy, globe + self.canthus * (level - globe)

    def settled(
        self, distance: Floats, xy: Floats, z: Floats, *, sooner: Floats | float = 0.0
    ) -> Floats:
        """Return heights (n,) that go over into the face's towards the outline.

        ``sooner`` is by how much of the way the change starts earlier.
        """
        share = smooth_step((distance / self.end_mm - 0.4 + sooner) / (0.55 + 0.9 * sooner))
        return z + share * (self.face(xy) - z)

    def on_face(self, distance: Floats) -> Floats:
        """Return points (n, 3) on the face's skin."""
        xy = self.at(distance)
        return np.column_stack([xy, self.face(xy)])


def upper_skin(columns: Columns) -> list[Floats]:
    """Return the upper lid's rings (n, 3), from the lashes' edge to the brow."""
    x = columns.edge[:, 0]
    platform = 2.7 - 0.8 * smooth_step((x - 2.0) / 10.0) - 0.7 * smooth_step((-x - 6.0) / 8.0)
    platform *= 1 - 0.45 * columns.canthus
    platform = _at_least(platform + UNFOLDED * columns.lowered_mm, LEAST_PLATFORM_MM)
    fold = np.exp(-np.maximum(columns.lowered_mm, 0.0) / FOLD_FADES_MM)
    fold *= 1 - 0.75 * columns.canthus
    height = _fold_height(columns, platform, fold)
    rows = []
    for share in (0.1, 0.25, 0.45, 0.65, 0.85):
        rows.append(_upper_ring(columns, platform * share, height))
    # The skin dives into the crease, comes forwards as a lip over it, and rolls over.
    for beyond, sink, pull in (
        (0.0, 0.85, -0.1),
        (0.25, 0.35, 0.55),
        (0.8, -0.1, 0.75),
        (1.7, 0.0, 0.25),
    ):
        ring = _upper_ring(columns, platform + beyond, height)
        ring[:, 2] -= sink * fold
        ring[:, :2] -= columns.outward * (pull * fold)[:, None]
        rows.append(ring)
    start = platform + 1.7
    for share in OUTER_SHARES:
        rows.append(_upper_ring(columns, start + (columns.end_mm - start) * share, height))
    return rows


def _upper_ring(columns: Columns, distance: Floats, height: Callable[[Floats], Floats]) -> Floats:
    xy, z = columns.on_lid(distance)
    return np.column_stack([xy, columns.settled(distance, xy, z + height(distance))])


def _fold_height(columns: Columns, platform: Floats, fold: Floats) -> Callable[[Floats], Floats]:
    """Return by how much skin stands over the globe's hull, as a function of the distance.

    It is the face's own way over the hull, reached the slower the longer that way is, and what
    this lacks of a full fold beyond the crease.
    """

    def face(distance: Floats) -> Floats:
        xy, z = columns.on_lid(distance)
        over_hull = soft_max(columns.face(xy), z, 1.0) - z
        return over_hull * smooth_step((distance - 0.4 * platform) / slope)

    slope = np.ones_like(platform)
    slope = 0.6 * platform + 1.5 + 1.1 * face(platform + 3.0)
    missing = np.maximum(FOLD_MM * fold - face(platform + 1.2), 0.0)

    nose = smooth_step((-columns.edge[:, 0] - 5.0) / 6.0)
    fullness = FULLNESS_MM * np.maximum(1 - columns.canthus, nose)

    def height(distance: Floats) -> Floats:
        lip = smooth_step((distance - platform) / 1.3)
        fade = 1 - smooth_step((distance - platform - 1.0) / (0.75 * (columns.end_mm - platform)))
        full = (distance - platform) / (columns.end_mm - platform)
        full = fullness * np.sin(np.pi * np.clip(full, 0, 1)) ** 1.5
        return face(distance) + missing * lip * fade + full

    return height


def lower_skin(columns: Columns) -> list[Floats]:
    """Return the lower lid's rings (n, 3): a roll of muscle, a shallow furrow, then the cheek."""
    away = 1 - 0.8 * columns.canthus
    first = np.minimum(6.9 * (0.45 + 0.55 * away), 0.5 * columns.end_mm)
    rows = []
    for share in (0.05, 0.12, 0.22, 0.34, 0.46, 0.6, 0.74, 0.87, 1.0):
        rows.append(_lower_ring(columns, first * share, away))
    for share in OUTER_SHARES:
        rows.append(_lower_ring(columns, first + (columns.end_mm - first) * share, away))
    return rows


def _lower_ring(columns: Columns, distance: Floats, away: Floats) -> Floats:
    xy, z = columns.on_lid(distance)
    z0, cheek = columns.edge[:, 2], columns.face(columns.at(columns.end_mm))
    free = smooth_step((distance - 0.2) / (1.5 + 2.0 * columns.canthus))
    z = z + free * (soft_max(columns.face(xy), z, 3.0) - z)
    # Fat and muscle bridge the hollow between globe and cheek.
    bridge = z0 + (cheek - z0) * (distance / columns.end_mm) ** 0.8 - BRIDGE_SAG_MM
    z = z + free * (soft_max(bridge, z, 2.0) - z)
    roll = 0.22 * np.exp(-(((distance - 2.6) / 1.7) ** 2))
    furrow = -0.16 * np.exp(-(((distance - 6.2) / 1.3) ** 2))
    # Beside the outer corner the cheek falls away: a late step down to it would look like a bag.
    temple = 0.36 * smooth_step((columns.edge[:, 0] - 3.0) / 7.0)
    z = columns.settled(distance, xy, z + (roll + furrow) * away, sooner=temple)
    return np.column_stack([xy, z])


def _at_least(value: Floats, least: float) -> Floats:
    """Return a smooth maximum of values and a bound."""
    return soft_max(value, np.full_like(value, least), 1.2)
