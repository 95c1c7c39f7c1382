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

    Almond-shaped, opening about 9.5 mm: the upper lid covers 1.8 mm of the cornea with its peak
    towards the nose, the lower lid touches the limbus with its trough towards the temple. Beside
    the nose the rims are drawn out around the caruncle.
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
    # Cubic Bezier arcs, joined at the extremum; handles set the fullness towards each canthus.
    if upper:
        peak, medial, lateral = (
            (-1.2, 4.05),
            ((-13.4, -0.1), (-7.0, 4.05)),
            ((5.0, 4.05), (9.2, 2.35)),
        )
    else:
        peak, medial, lateral = (
            (2.0, -5.5),
            ((-12.6, -3.1), (-4.8, -5.5)),
            ((6.2, -5.5), (9.8, -2.2)),
        )
    share = (peak[0] - MEDIAL_MM[0]) / (LATERAL_MM[0] - MEDIAL_MM[0])
    t = np.where(s < share, s / share, (s - share) / (1 - share))
    nose = _bezier(t, MEDIAL_MM, *medial, peak)
    temple = _bezier(t, peak, *lateral, LATERAL_MM)
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
