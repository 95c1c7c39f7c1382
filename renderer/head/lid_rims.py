"""The inner edges of our character's eyelids, drawn on the globe in any pose. Pure numpy.

Patch space (see ``lid_pose``). A place on a rim is named by its share, 0 at the nose to 1 at the
temple, and keeps it while the lids move.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.eye.lids import Curve, LidRims
from renderer.head.lid_pose import (
    LOWER_FOLLOWS,
    LOWER_GOES_NASAL_MM,
    LOWER_RISES_MM,
    SIDEWAYS_FOLLOWS,
    STRAIGHT,
    UPPER_FOLLOWS,
    LidPose,
)
from renderer.head.lid_shell import on_globe

LATERAL_MM: Final = (12.6, 0.55)  # canthi, frontal plane: where the rims meet at the temple
MEDIAL_MM: Final = (-16.6, -2.1)  # ... and beside the nose
LATERAL_Z_MM: Final = 4.4
MEDIAL_Z_MM: Final = 6.4
CLEARANCE_MM: Final = 0.06  # tear film between rim and globe
LEAVING_MM: Final = 1.5  # how softly the rims leave the globe for the canthi
OVERLAP_MM: Final = 0.15  # of shut lids, so that nothing shines between them
# Cubic Bezier arcs of the open rims, joined at the extremum: the extremum, and the handles towards
# the nose and the temple, which set the fullness. Upright handles make the inner canthus round.
_UPPER: Final = ((-1.2, 4.05), ((-16.35, -1.05), (-8.2, 4.05)), ((5.0, 4.05), (9.2, 2.35)))
_LOWER: Final = ((2.0, -5.5), ((-16.35, -2.85), (-5.2, -5.5)), ((6.2, -5.5), (9.8, -2.2)))


def rim_shares(samples: int) -> Floats:
    """Return shares 0 to 1 along a rim, dense at the canthi."""
    return 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, samples))


def rim_curves(pose: LidPose = STRAIGHT, *, samples: int = 129) -> tuple[Curve, Curve]:
    """Return the inner edges of upper and lower lid in patch space, canthus at the nose first.

    Almond-shaped, opening about 9.5 mm when looking straight ahead: the upper lid covers 1.8 mm of
    the cornea with its peak towards the nose, the lower lid touches the limbus with its trough
    towards the temple. Beside the nose the rims are drawn out around the caruncle.
    """
    shares = rim_shares(samples)
    return rim(shares, pose, is_upper=True), rim(shares, pose, is_upper=False)


def rim(shares: Floats, pose: LidPose, *, is_upper: bool) -> Curve:
    """Return the rim's points (n, 3) at shares (n,) of the way from the nose to the temple."""
    xy = _looking(shares, pose, is_upper=is_upper)
    if is_upper:
        line = _shut(_looking(rim_shares(257), pose, is_upper=False))
        y = np.interp(xy[:, 0], *line.T) - OVERLAP_MM * _bow(xy[:, 0])
        shut = np.column_stack([xy[:, 0], y])
    else:
        shut = _shut(xy)
    xy = xy + pose.blink * (shut - xy)
    return np.column_stack([xy, _rim_depth(xy, pose)])


def lid_rims(eye: int, pose: LidPose = STRAIGHT) -> LidRims:
    """Return the rims of the viewer's left (0) or right (1) eye in eye space, ascending x."""
    upper, lower = (_in_sight(pose.turned_to_eye(curve)) for curve in rim_curves(pose))
    if eye == 0:
        upper, lower = (curve[::-1] * [-1.0, 1.0, 1.0] for curve in (upper, lower))
    return LidRims(upper_mm=upper, lower_mm=lower)


def _in_sight(curve: Curve) -> Curve:
    """Drop what lies beyond the eye's own horizon when it looks far aside, so that x ascends."""
    start = len(curve) // 2
    x = curve[:, 0]
    temple = np.diff(np.maximum.accumulate(x[start:]), prepend=-np.inf) > 1e-6
    nose = np.diff(np.minimum.accumulate(x[start::-1]), prepend=np.inf) < -1e-6
    return np.asarray(curve[np.concatenate([nose[:0:-1], temple])])


def _looking(shares: Floats, pose: LidPose, *, is_upper: bool) -> Floats:
    """Return the open rim (n, 2): its arch over the line of the canthi grows with the gaze."""
    xy = _open(shares, is_upper=is_upper)
    arch = xy[:, 1] - _chord(xy[:, 0])
    extremum = _UPPER[0] if is_upper else _LOWER[0]
    highest = extremum[1] - float(_chord(np.array(extremum[0])))
    sideways, up = pose.corneal_shift_mm
    follows = UPPER_FOLLOWS if is_upper else LOWER_FOLLOWS
    x = xy[:, 0] + SIDEWAYS_FOLLOWS * sideways * _bow(xy[:, 0])
    return np.column_stack([x, xy[:, 1] + follows * up * arch / highest])


def _shut(lower: Floats) -> Floats:
    """Return where the lower rim (n, 2) goes when the eye shuts."""
    bow = _bow(lower[:, 0])
    return lower + np.column_stack([-LOWER_GOES_NASAL_MM * bow, LOWER_RISES_MM * bow])


def _open(shares: Floats, *, is_upper: bool) -> Floats:
    peak, medial, lateral = _UPPER if is_upper else _LOWER
    joint = (peak[0] - MEDIAL_MM[0]) / (LATERAL_MM[0] - MEDIAL_MM[0])
    t = np.where(shares < joint, shares / joint, (shares - joint) / (1 - joint))
    nose = _bezier(t, MEDIAL_MM, *medial, peak)
    temple = _bezier(t, peak, *lateral, LATERAL_MM)
    return np.where((shares < joint)[:, None], nose, temple)


def _bezier(t: Floats, *points: tuple[float, float]) -> Floats:
    a, b, c, d = (np.array(point) for point in points)
    t = t[:, None]
    return np.asarray(
        (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d
    )


def _chord(x: Floats) -> Floats:
    """Return the height of the straight line between the canthi."""
    share = (x - MEDIAL_MM[0]) / (LATERAL_MM[0] - MEDIAL_MM[0])
    return np.asarray(MEDIAL_MM[1] + share * (LATERAL_MM[1] - MEDIAL_MM[1]))


def _bow(x: Floats) -> Floats:
    """Return 1 midway between the canthi, falling to 0 at both with a level end."""
    along = 2 * (x - MEDIAL_MM[0]) / (LATERAL_MM[0] - MEDIAL_MM[0]) - 1
    return np.asarray(np.clip(1 - along**2, 0, 1) ** 1.5)


def _rim_depth(xy: Floats, pose: LidPose) -> Floats:
    """Slide on the eye, cornea included, and leave it smoothly for the canthi."""
    globe = on_globe(xy, pose, lift=CLEARANCE_MM)
    x = xy[:, 0]
    canthus = np.where(x < 0, MEDIAL_Z_MM - 0.1 * (x - MEDIAL_MM[0]), LATERAL_Z_MM)
    return soft_max(globe, canthus, LEAVING_MM)


def soft_max(a: Floats, b: Floats, width_mm: Floats | float) -> Floats:
    """Return the larger of two heights, rounded where they meet and never below either.

    Exact where they differ by more than ``width_mm``.
    """
    nearness = np.maximum(width_mm - np.abs(a - b), 0.0)
    return np.asarray(np.maximum(a, b) + nearness * nearness / (4 * width_mm))


def smooth_step(x: Floats) -> Floats:
    """Ease from 0 to 1 over x from 0 to 1, with two smooth derivatives (Perlin 2002)."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * x * (x * (6 * x - 15) + 10))
