"""The inner edges of our character's eyelids, drawn on the globe. Pure numpy.

Patch space is eye space with the temple at +x, whichever eye it is: millimetres, origin at the
globe's centre, +z straight ahead, +y up.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.lids import Curve, LidRims
from renderer.eye.optics import surface_height

LATERAL_MM: Final = (12.6, 0.55)  # canthi, frontal plane: where the rims meet at the temple
MEDIAL_MM: Final = (-16.6, -2.1)  # ... and beside the nose
LATERAL_Z_MM: Final = 4.6
MEDIAL_Z_MM: Final = 7.0
CLEARANCE_MM: Final = 0.06  # tear film between rim and globe


def rim_curves(*, samples: int = 129) -> tuple[Curve, Curve]:
    """Return the inner edges of upper and lower lid in patch space, canthus at the nose first.

    Opening about 9.1 mm: the upper lid covers 1.9 mm of the cornea with its peak towards the nose,
    the lower lid touches the limbus with its trough towards the temple.
    """
    s = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, samples))  # dense at the canthi
    return _rim(s, upper=True), _rim(s, upper=False)


def lid_rims(eye: int) -> LidRims:
    """Return the rims of the viewer's left (0) or right (1) eye in eye space, ascending x."""
    upper, lower = rim_curves()
    if eye == 0:
        upper, lower = (curve[::-1] * [-1.0, 1.0, 1.0] for curve in (upper, lower))
    return LidRims(upper_mm=upper, lower_mm=lower)


def _rim(s: Floats, *, upper: bool) -> Curve:
    """Return the rim at shares 0 to 1 of the way from the nose to the temple."""
    (x1, y1), (x0, y0) = LATERAL_MM, MEDIAL_MM
    # Cubic Bezier arcs, joined at the extremum; handles set the fullness towards each canthus.
    if upper:
        peak, first, second = (-1.2, 3.75), (0.36, 0.62), (0.50, 0.62)
    else:
        peak, first, second = (2.2, -5.35), (0.50, 0.58), (0.46, 0.60)
    sign = 1.0 if upper else -1.0
    share = (peak[0] - x0) / (x1 - x0)
    t = np.where(s < share, s / share, (s - share) / (1 - share))
    nose = _bezier(
        t,
        (x0, y0),
        (x0 + first[0] * (peak[0] - x0), y0 + sign * first[1] * abs(peak[1] - y0)),
        (peak[0] - second[0] * (peak[0] - x0), peak[1]),
        peak,
    )
    temple = _bezier(
        t,
        peak,
        (peak[0] + 0.50 * (x1 - peak[0]), peak[1]),
        (x1 - 0.26 * (x1 - peak[0]), y1 + sign * 0.50 * abs(peak[1] - y1)),
        (x1, y1),
    )
    xy = np.where((s < share)[:, None], nose, temple)
    return np.column_stack([xy, _rim_depth(xy)])


def _bezier(t: Floats, *points: tuple[float, float]) -> Floats:
    a, b, c, d = (np.array(point) for point in points)
    t = t[:, None]
    return np.asarray(
        (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d
    )


def _rim_depth(xy: Floats) -> Floats:
    """Slide on the globe, cornea included, and leave it smoothly towards the canthi."""
    r = np.linalg.norm(xy, axis=1)
    on_globe = globe_height(np.minimum(r, 10.8)) + CLEARANCE_MM
    medial = smooth_step((-xy[:, 0] - 7.5) / 8.5)
    lateral = smooth_step((xy[:, 0] - 8.0) / 4.6)
    depth = on_globe * (1 - medial) + MEDIAL_Z_MM * medial
    return depth * (1 - lateral) + LATERAL_Z_MM * lateral


def globe_height(r_mm: Floats) -> Floats:
    """Return the height in mm of sclera or cornea at a distance from the gaze axis."""
    return np.asarray(surface_height(np.minimum(r_mm, GLOBE_RADIUS_MM - 1e-6))[0])


def smooth_step(x: Floats) -> Floats:
    """Ease from 0 to 1 over x from 0 to 1, with two smooth derivatives (Perlin 2002)."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * x * (x * (6 * x - 15) + 10))
