"""The surface that lids slide on: the turned globe, its cornea included. Pure numpy, patch space.

Everything is a distance from the globe's centre that depends on the angle to the gaze alone. Tissue
spans the groove around the cornea, so lids follow the hull of the globe's profile, not the profile.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from renderer.body.makehuman import Floats
from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.optics import surface_height
from renderer.head.lid_pose import LidPose

_ANGLES: Final = np.radians(np.linspace(0.0, 90.0, 721))  # from the gaze axis
SOFTNESS_DEG: Final = 3.0  # over which tissue rounds the hull
STEEPEST: Final = 0.90  # share of a dome's radius from where it falls on straight


def globe_radius(angle: Floats) -> Floats:
    """Return how far the eye's surface lies from the globe's centre at angles from the gaze."""
    return np.asarray(np.interp(angle, _ANGLES, _profile()))


def hull_radius(angle: Floats) -> Floats:
    """Return the same for the smooth hull that lids follow; nowhere below the eye's surface."""
    return np.asarray(np.interp(angle, _ANGLES, _hull()))


def on_globe(xy: Floats, pose: LidPose, *, lift: Floats | float = 0.0) -> Floats:
    """Return z (...,) of the eye's surface, lifted by mm, over points (..., 2)."""
    return _on_surface(xy, pose, lift=lift, radius=globe_radius)


def on_hull(xy: Floats, pose: LidPose, *, lift: Floats | float = 0.0) -> Floats:
    """Return z (...,) of the lids' hull, lifted by mm, over points (..., 2)."""
    return _on_surface(xy, pose, lift=lift, radius=hull_radius)


def height_over_globe(points: Floats, pose: LidPose) -> Floats:
    """Return how far points (..., 3) lie outside of the eye's surface, in mm from its centre."""
    length = np.linalg.norm(points, axis=-1)
    cosine = points @ pose.gaze / np.maximum(length, 1e-9)
    return np.asarray(length - globe_radius(np.arccos(np.clip(cosine, -1, 1))))


def _on_surface(
    xy: Floats, pose: LidPose, *, lift: Floats | float, radius: Callable[[Floats], Floats]
) -> Floats:
    r = np.hypot(xy[..., 0], xy[..., 1])
    z = _dome(r, GLOBE_RADIUS_MM + 0.5 + np.asarray(lift))
    for _ in range(8):  # the profile is nearly a sphere: each step gains a digit
        length = np.sqrt(r * r + z * z)
        cosine = (xy @ pose.gaze[:2] + z * pose.gaze[2]) / length
        z = _dome(r, radius(np.arccos(np.clip(cosine, -1, 1))) + lift)
    return z


def _dome(r: Floats, radius: Floats) -> Floats:
    """Return the height of a sphere over its equator; beside it a slope that runs on straight."""
    share = np.minimum(r / radius, STEEPEST)
    foot = np.sqrt(1 - share * share)
    return np.asarray(radius * foot - np.maximum(r - STEEPEST * radius, 0.0) * share / foot)


@functools.cache
def _profile() -> Floats:
    r = np.linspace(0.0, GLOBE_RADIUS_MM * (1 - 1e-9), 6001)
    z = surface_height(r)[0]
    return np.interp(_ANGLES, np.arctan2(r, z), np.hypot(r, z))


@functools.cache
def _hull() -> Floats:
    """Return the convex hull of the profile, softened and lifted back over it."""
    radius = _profile()
    r, z = radius * np.sin(_ANGLES), radius * np.cos(_ANGLES)
    kept: list[int] = []
    for place in range(len(r)):
        while len(kept) > 1 and _turns_out(r, z, (kept[-2], kept[-1], place)):
            kept.pop()
        kept.append(place)
    z_hull = np.interp(r, r[kept], z[kept])
    soft = gaussian_filter1d(np.hypot(r, z_hull), SOFTNESS_DEG / 0.125, mode="nearest")
    return np.asarray(soft + max(float((radius - soft).max()), 0.0))


def _turns_out(r: Floats, z: Floats, places: tuple[int, int, int]) -> bool:
    a, b, c = places
    return bool((r[b] - r[a]) * (z[c] - z[a]) - (z[b] - z[a]) * (r[c] - r[a]) >= 0)
