"""The cornea's optics: its surface, Snell's law, Fresnel's equations. Pure numpy.

Eye space in millimetres (see anatomy). The surface is Baker's cornea joined to the scleral sphere
by a smooth maximum (ours), so that the limbus has neither edge nor crease. ``shaders/surface.glsl``
and ``shaders/refraction.glsl`` say the same to the GPU; tests compare the two.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import (
    APEX_MM,
    CORNEA_ASPHERICITY,
    CORNEA_IOR,
    CORNEA_RADIUS_MM,
    GLOBE_RADIUS_MM,
    IRIS_Z_MM,
    JOIN_HEIGHT_MM,
    JOIN_REACH_MM,
    LIMBUS_RADIUS_MM,
    PROFILE_END_MM,
)

Array = npt.NDArray[np.float64]


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
    ratio = (g - c) / (g + c)
    second = (c * (g + c) - 1.0) / (c * (g - c) + 1.0)
    return np.where(g2 > 0.0, 0.5 * ratio**2 * (1.0 + second**2), 1.0)


def cornea_from_inside(origin: Array, direction: Array) -> Array:
    """Return where rays from the chamber meet Baker's cornea, (..., 3); NaN beyond the limbus.

    Exact intersection with the conic. The join with the sclera, which differs from it by less than
    0.08 mm under the opaque limbus, is left out.
    """
    depth = APEX_MM - origin[..., 2]
    dx, dy, dz = direction[..., 0], direction[..., 1], -direction[..., 2]
    ox, oy = origin[..., 0], origin[..., 1]
    p, R = CORNEA_ASPHERICITY, CORNEA_RADIUS_MM
    a = p * dz * dz + dx * dx + dy * dy
    b = p * depth * dz - R * dz + ox * dx + oy * dy
    c = p * depth * depth - 2 * R * depth + ox * ox + oy * oy
    t = (-b + np.sqrt(np.maximum(b * b - a * c, 0.0))) / a
    hit = origin + t[..., None] * direction
    is_cornea = np.hypot(hit[..., 0], hit[..., 1]) <= LIMBUS_RADIUS_MM
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
