"""The cornea's optics: its surface, Snell's law, Fresnel's equations. Pure numpy.

Eye space in millimetres (see anatomy). The surface is Baker's cornea joined to the scleral sphere
by a smooth maximum (ours), so that the limbus has neither edge nor crease. ``shaders/surface.glsl``
and ``shaders/refraction.glsl`` say the same to the GPU; tests compare the two.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import (
    APEX_MM,
    CLEAR_REACH_MM,
    CORNEA_ASPHERICITY,
    CORNEA_IOR,
    CORNEA_RADIUS_MM,
    GLOBE_RADIUS_MM,
    IRIS_Z_MM,
    JOIN_HEIGHT_MM,
    JOIN_REACH_MM,
    LIMBUS_HEIGHT_RATIO,
    LIMBUS_INSET_MM,
    LIMBUS_RADIUS_MM,
    LIMBUS_WIDTH_MM,
    PROFILE_END_MM,
)

Array = npt.NDArray[np.float64]

_JOIN_STEPS: Final = 3  # Newton's, from the conic to its join with the sclera


def corneal_sag(r_mm: Array | float) -> Array:
    """Return the depth in mm of Baker's cornea behind its apex at a distance from the axis."""
    r = np.asarray(r_mm, dtype=np.float64)
    root = np.sqrt(np.maximum(CORNEA_RADIUS_MM**2 - CORNEA_ASPHERICITY * r * r, 0.0))
    return np.asarray((CORNEA_RADIUS_MM - root) / CORNEA_ASPHERICITY)


def surface_height(r_mm: Array | float) -> tuple[Array, Array]:
    """Return height z in mm and slope dz/dr of the front surface at a distance from the axis.

    Cornea near the axis, sphere beyond the limbus, between them the smooth maximum
    (a + b + sqrt((a - b)^2 + k^2)) / 2 whose k fades away from the limbus: infinitely smooth.
    Valid for r below GLOBE_RADIUS_MM.
    """
    r = np.asarray(r_mm, dtype=np.float64)
    on_cornea = np.minimum(r, PROFILE_END_MM)
    sag = corneal_sag(on_cornea)
    cornea = APEX_MM - sag
    cornea_slope = -on_cornea / (CORNEA_RADIUS_MM - CORNEA_ASPHERICITY * sag)
    globe = np.sqrt(np.maximum(GLOBE_RADIUS_MM**2 - r * r, 1e-12))
    globe_slope = -r / globe
    offset = (on_cornea - LIMBUS_RADIUS_MM) / JOIN_REACH_MM
    k = JOIN_HEIGHT_MM * np.exp(-(offset**4))
    k_slope = -4.0 * offset**3 / JOIN_REACH_MM * k
    q = np.sqrt((cornea - globe) ** 2 + k * k) + 1e-300
    weight = 0.5 * (1.0 + (cornea - globe) / q)
    height = 0.5 * (cornea + globe + q)
    slope = weight * cornea_slope + (1.0 - weight) * globe_slope + 0.5 * k * k_slope / q
    beyond = r >= PROFILE_END_MM
    return np.where(beyond, globe, height), np.where(beyond, globe_slope, slope)


def surface_normal(p_eye: Array) -> Array:
    """Return the unit normals (..., 3) at points (..., 3) of the surface."""
    p = np.asarray(p_eye, dtype=np.float64)
    r = np.hypot(p[..., 0], p[..., 1])
    _, slope = surface_height(np.minimum(r, PROFILE_END_MM))
    scale = -slope / np.maximum(r, 1e-12)
    front = np.stack([p[..., 0] * scale, p[..., 1] * scale, np.ones_like(r)], axis=-1)
    is_front = (p[..., 2] > 0.0) & (r < PROFILE_END_MM)
    return unit(np.where(is_front[..., None], front, p))


def cornea_share(points: Array) -> Array:
    """Return the clear share, 1 cornea to 0 sclera, over points (..., 2 or more) of the front.

    What veils the view of the iris also veils the light on its way in.
    """
    r = np.hypot(points[..., 0], points[..., 1] / LIMBUS_HEIGHT_RATIO)
    edge = LIMBUS_RADIUS_MM - LIMBUS_INSET_MM
    return np.asarray(1.0 / (1.0 + np.exp((r - edge) / LIMBUS_WIDTH_MM)))


def unit(v: Array) -> Array:
    """Return vectors (..., 3) scaled to length 1."""
    return np.asarray(v / np.linalg.norm(v, axis=-1, keepdims=True))


def refract(incident: Array, normal: Array, *, ior_ratio: float) -> Array:
    """Bend unit directions at a surface (Snell); ``ior_ratio`` is n before over n behind it.

    ``normal`` points against ``incident``. Total internal reflection gives NaN.
    """
    cosine = -np.sum(incident * normal, axis=-1, keepdims=True)
    inside = 1.0 - ior_ratio**2 * (1.0 - cosine**2)
    root = np.sqrt(np.where(inside >= 0.0, inside, np.nan))
    return np.asarray(ior_ratio * incident + (ior_ratio * cosine - root) * normal)


def fresnel(cosine: Array | float, *, ior: float = CORNEA_IOR) -> Array:
    """Return the reflectance of an unpolarised ray from outside, exactly.

    Cook and Torrance 1982, eq. 4 (with g^2 = n^2 + c^2 - 1). ``ior`` below 1 means a ray from
    inside; total reflection gives 1.
    """
    c = np.clip(np.asarray(cosine, dtype=np.float64), 0.0, 1.0)
    g2 = ior**2 + c * c - 1.0
    g = np.sqrt(np.maximum(g2, 0.0))
    ratio = (g - c) / np.maximum(g + c, 1e-12)
    second = (c * (g + c) - 1.0) / (c * (g - c) + 1.0)
    return np.where(g2 > 0.0, 0.5 * ratio**2 * (1.0 + second**2), 1.0)


def cornea_from_inside(origin: Array, direction: Array) -> Array:
    """Return where rays from the chamber meet the front surface, (..., 3); NaN beyond the limbus.

    Exact intersection with Baker's conic, then Newton's steps to its smooth join with the sclera.
    """
    depth = APEX_MM - origin[..., 2]
    dx, dy, dz = direction[..., 0], direction[..., 1], -direction[..., 2]
    ox, oy = origin[..., 0], origin[..., 1]
    p, R = CORNEA_ASPHERICITY, CORNEA_RADIUS_MM
    a = p * dz * dz + dx * dx + dy * dy
    b = p * depth * dz - R * dz + ox * dx + oy * dy
    c = p * depth * depth - 2 * R * depth + ox * ox + oy * oy
    t = (-b + np.sqrt(np.maximum(b * b - a * c, 0.0))) / a
    for _ in range(_JOIN_STEPS):
        hit = origin + t[..., None] * direction
        r = np.hypot(hit[..., 0], hit[..., 1])
        height, slope = surface_height(np.minimum(r, PROFILE_END_MM))
        outwards = (hit[..., 0] * dx + hit[..., 1] * dy) / np.maximum(r, 1e-9)
        rate = np.maximum(-dz - slope * outwards, 0.05)
        t = t - np.clip((hit[..., 2] - height) / rate, -0.5, 0.5)
    hit = origin + t[..., None] * direction
    is_cornea = np.hypot(hit[..., 0], hit[..., 1]) <= CLEAR_REACH_MM
    return np.where(is_cornea[..., None], hit, np.nan)


def conic_normal(p_eye: Array) -> Array:
    """Return the outward unit normals of Baker's cornea itself at points (..., 3) on it."""
    depth = APEX_MM - p_eye[..., 2]
    along = CORNEA_RADIUS_MM - CORNEA_ASPHERICITY * depth
    return unit(np.stack([p_eye[..., 0], p_eye[..., 1], along], axis=-1))


def to_iris_plane(p_eye: Array, direction: Array) -> Array:
    """Return where rays (..., 3) that travel into the eye meet the iris plane, (..., 2) in mm."""
    t = (IRIS_Z_MM - p_eye[..., 2]) / direction[..., 2]
    return np.asarray(p_eye[..., :2] + t[..., None] * direction[..., :2])
