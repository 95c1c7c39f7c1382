"""Light on the conjunctiva in the eyes' corners, baked per vertex: the globe's own, past the lids.

Pure numpy. What the lids and their lashes take is summed as the globe's shaders sum it
(``shaders/lid_sky.glsl``, ``lids.glsl``), so that no edge of shade shows where the sheet leaves
the globe.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices
from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.lids import LidRims
from renderer.head.lid_pose import LidPose
from renderer.head.lid_rims import rim_curves
from renderer.head.patch_space import to_patch
from renderer.head.skin_light import SkinLight, scatter, sky_radiance
from renderer.light import Sky

# The lids' middle surface over the globe (``lids.glsl``), and over what stands out.
LID_FRONT_MM: Final = (13.4 - GLOBE_RADIUS_MM, 0.4)
RESTS_MM: Final = 1.0  # off the globe: what is nearer counts as lying on it
OUT_MM: Final = (12.3, 15.0)  # from the globe's centre: what stands out between the lids
SOFTNESS_MM: Final = (0.8, 0.35)  # of the lids' shade from the sky, and from the sun ...
SOFTENING: Final = 0.12  # ... and per mm of way
RAYS: Final = 64
LID_REFLECTANCE: Final = (0.38, 0.24, 0.18)
LASH_REFLECTANCE: Final = (0.02, 0.012, 0.008)
LASH_REACH_MM: Final = 7.2
LASH_CURL: Final = 0.09  # height over the rim per square of the way, 1/mm
LASH_COVER: Final = 0.324  # of lashes seen square on: 2 x 0.9 x 0.03 mm x 6 a mm
SUN_COVER: Final = 0.29  # of the three rows of hairs, one behind the other, that the sun meets
LASH_ENDS_MM: Final = (10.7, 12.2)  # off the middle
MIRRORED: Final = 0.4  # of the sky that the point sees
SCATTER_WRAP: Final = (0.30, 0.23, 0.20)  # thicker tissue than ``sclera.glsl`` has
SHADE_SEEP: Final = (0.72, 0.98, 1.05)


def light_corner(
    points_mm: Floats,
    normals: Floats,
    triangles: Indices,
    *,
    eye: int,
    pose: LidPose,
    sky: Sky,
    sun: Floats,
) -> SkinLight:
    """Return the light on one eye's corners; ``sun`` (n,) is how much of it the head leaves."""
    side = np.array([1.0 if eye else -1.0, 1.0, 1.0])  # patch space has the temple at +x
    places, lies = _settled(to_patch(points_mm, eye))
    # There the globe's own slope counts: the sheet's edge, which dips below it, is not to be seen.
    normals = normals + lies * (places * side / GLOBE_RADIUS_MM - normals)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    rims = LidRims(*rim_curves(pose, samples=513))
    rays = _hemispheres(normals)
    towards = rays * side
    every = np.broadcast_to(places[:, None], rays.shape).reshape(-1, 3)
    lids, lashes = past_lids(every, towards.reshape(-1, 3), rims, SOFTNESS_MM[0])
    free = sky_radiance(sky, rays.reshape(-1, 3))
    around = 0.5 * sky_radiance(sky, np.array([0.0, 0.0, 1.0]))
    behind = lashes[:, None] * free + (1 - lashes[:, None]) * (LASH_REFLECTANCE * around)
    kept = lids[:, None] * behind + (1 - lids[:, None]) * (LID_REFLECTANCE * around)
    ambient = kept.reshape(*rays.shape).mean(axis=1)
    share = (lids * lashes).reshape(rays.shape[:2]).mean(axis=1)

    to_sun = np.broadcast_to(sky.sun_direction * side, places.shape)
    sunny, hairs = past_lids(places, to_sun, rims, SOFTNESS_MM[1], one_beam=True)
    reaching = sun * sunny * hairs
    wrap = np.array(SCATTER_WRAP)
    cosine = (normals @ sky.sun_direction)[:, None]
    wrapped = np.maximum((cosine + wrap) / (1 + wrap) ** 2, 0.0)
    direct = sky.sun_irradiance * reaching[:, None] ** np.array(SHADE_SEEP) * wrapped
    diffuse = ambient + direct / np.pi
    # On the globe the light has seeped in as its shader lets it.
    deep = scatter(points_mm, triangles, diffuse)
    diffuse = deep + lies * (diffuse - deep)
    # What mirrors at a slant sees more of lids and nose than what lies beneath.
    return SkinLight(diffuse, MIRRORED * share * share, reaching)


def _settled(points: Floats) -> tuple[Floats, Floats]:
    """Return points (n, 3) of a sheet that softly leaves the globe, laid on it where near,

    and how much (n, 1) it lies there, 0 to 1.
    """
    length = np.linalg.norm(points, axis=1, keepdims=True)
    over = np.maximum(length - GLOBE_RADIUS_MM, 0.0)
    off = np.minimum(over / RESTS_MM, 1.0) ** 2
    return np.asarray(points * ((GLOBE_RADIUS_MM + over * off) / length)), 1.0 - off


def past_lids(
    points: Floats, directions: Floats, rims: LidRims, softness_mm: float, *, one_beam: bool = False
) -> tuple[Floats, Floats]:
    """Return what shares (n,) of rays from points (n, 3) pass the lids, and their lashes.

    ``rims`` and points share a space whose origin is the globe's centre. Of ``one_beam``, a single
    direction, hairs take what they take of sunlight; else what they take of a sky on average.
    """
    along = (points * directions).sum(axis=-1)
    square = (points * points).sum(axis=-1)
    # Off the globe the lids lie further out, too.
    front = np.maximum(np.sqrt(square), GLOBE_RADIUS_MM)
    front = front + np.interp(front, OUT_MM, LID_FRONT_MM)
    reach = np.sqrt(np.maximum(along * along - square + front * front, 0.0)) - along
    at = points + reach[:, None] * directions
    upper, lower = (
        np.interp(at[:, 0], curve[:, 0], curve[:, 1]) for curve in (rims.upper_mm, rims.lower_mm)
    )
    room = np.minimum(upper - at[:, 1], at[:, 1] - lower)
    soft = softness_mm + SOFTENING * reach
    share = np.clip(0.5 + room / (2 * soft), 0.0, 1.0)
    taken = _lash_cover(at, directions, upper - at[:, 1], one_beam=one_beam)
    return share * share * (3 - 2 * share), 1.0 - taken


def _lash_cover(at: Floats, directions: Floats, room: Floats, *, one_beam: bool) -> Floats:
    """Return the share (n,) that lashes take on average of rays that leave the lids' front."""
    climb = directions[:, 1] / np.maximum(directions[:, 2], 0.05)
    root2 = climb * climb - 4 * LASH_CURL * room
    meets = (climb > 0.0) & (root2 > 0.0)
    way = np.maximum(climb - np.sqrt(np.maximum(root2, 0.0)), 0.0) / (2 * LASH_CURL * LASH_REACH_MM)
    # A ray along the hairs passes more of them than one across.
    slant = np.minimum(1 / np.sqrt(np.maximum(1 - directions[:, 2] ** 2, 0.04)), 2.5)
    start, end = LASH_ENDS_MM
    out = np.clip((np.abs(at[:, 0]) - start) / (end - start), 0.0, 1.0)
    if one_beam:  # hairs of different lengths: the shade thins out from the roots on
        taken = SUN_COVER * np.maximum(1 - way, 0.0) ** 1.5
    else:
        taken = LASH_COVER * slant * np.maximum(1 - way * way, 0.0)
    taken = taken * (1 - out * out * (3 - 2 * out))
    return np.asarray(np.where(meets, np.minimum(taken, 0.9), 0.0))


def _hemispheres(normals: Floats) -> Floats:
    """Return RAYS cosine-weighted directions about each normal, (n, RAYS, 3)."""
    side = np.cross(normals, [0.0, 1.0, 0.1])
    side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-9)
    up = np.cross(side, normals)
    number = np.arange(RAYS)
    square, turn = (number + 0.5) / RAYS, 2.399963 * number  # a spiral, a golden angle apart
    local = np.stack(
        [np.sqrt(square) * np.cos(turn), np.sqrt(square) * np.sin(turn), np.sqrt(1 - square)]
    )
    frames = np.stack([side, up, normals], axis=-1)
    return np.asarray(np.einsum("nck,kr->nrc", frames, local))
