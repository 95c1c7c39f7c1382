"""Light on the skin, baked per vertex for one sky: sun and sky, shadowed, then scattered.

Pure numpy and scipy. The head does not move during a clip, so what leaves the skin diffusely is
the same in every frame. Light diffuses under the surface of the mesh itself, red the furthest.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import cg

from renderer.body.makehuman import Floats, Indices
from renderer.eye.place import eye_centre_mm
from renderer.head.sky_visibility import Visible, directions
from renderer.light import Sky
from renderer.spherical_harmonics import sh_basis

# How far light of each colour wanders in skin, standard deviation in mm, and the share of it that
# does (after the diffusion profiles of d'Eon and Luebke 2007, GPU Gems 3, ch. 14).
SCATTER_MM: Final = (1.25, 0.5, 0.32)
SCATTERED: Final = (0.75, 0.7, 0.6)
BOUNCE_ALBEDO: Final = (0.30, 0.20, 0.155)  # what the covered directions send: skin and sweater
# Around the eyes they send more: nose and cheek catch over twice as much sun as typical light has,
# and light goes to and fro between them.
SOCKET_BOUNCE: Final = (1.00, 0.91, 0.87)
FOLD_COVERED: Final = (0.5, 0.85)  # from where on nothing but a fold's own walls covers
SOCKET_MM: Final = (22.0, 9.0)  # half widths of that region, across and up


@dataclass(frozen=True)
class SkinLight:
    """Per vertex: radiance of white skin (n, 3); how free sky and sun are (n,), 0 to 1."""

    diffuse: Floats
    ambient: Floats
    sun: Floats


def sky_radiance(sky: Sky, towards: Floats) -> Floats:
    """Return the surroundings' radiance (n, 3) without the sun in unit directions (n, 3)."""
    return np.asarray(np.maximum(sh_basis(towards) @ np.asarray(sky.ambient_sh), 0.0))


def light_skin(
    points_mm: Floats,
    normals: Floats,
    triangles: Indices,
    *,
    sky: Sky,
    open_sky: Visible,
    sun: Floats,
) -> SkinLight:
    """Return the light on one mesh.

    ``open_sky`` (n, DIRECTIONS) and ``sun`` (n,) say how much of each the head leaves free.
    """
    towards = directions()
    cosine = np.maximum(normals @ towards.T, 0.0)
    weight = cosine * (np.pi / np.maximum(cosine.sum(axis=1, keepdims=True), 1e-6))
    free = weight * open_sky
    ambient = free.sum(axis=1) / np.pi
    sun_cosine = np.maximum(normals @ sky.sun_direction, 0.0)
    direct = (sun * sun_cosine)[:, None] * sky.sun_irradiance
    irradiance = free @ sky_radiance(sky, towards) + direct
    typical = np.pi * sky_radiance(sky, towards).mean(axis=0) + 0.3 * sky.sun_irradiance
    irradiance += typical * _bounce(points_mm, 1 - ambient)
    diffuse = scatter(points_mm, triangles, irradiance / np.pi)
    return SkinLight(diffuse, ambient, sun)


def _bounce(points_mm: Floats, covered: Floats) -> Floats:
    """Return the share (n, 3) of typical light that points get from covered directions (n,)."""
    bounce = covered[:, None] * BOUNCE_ALBEDO
    # In a fold what covers is skin in the same shade: the crease stays dark.
    deep = np.clip((covered - FOLD_COVERED[0]) / (FOLD_COVERED[1] - FOLD_COVERED[0]), 0.0, 1.0)
    sunlit = covered * (1.0 - deep)
    for eye in (0, 1):
        x, y, z = (points_mm - eye_centre_mm(eye)).T
        near = np.exp(-((x / SOCKET_MM[0]) ** 2) - ((y - 9.0) / SOCKET_MM[1]) ** 2) * (z > -5.0)
        bounce += (near * sunlit)[:, None] * (np.array(SOCKET_BOUNCE) - BOUNCE_ALBEDO)
    return bounce


def scatter(points_mm: Floats, triangles: Indices, values: Floats) -> Floats:
    """Let (n, 3) values diffuse along a mesh by SCATTER_MM: one implicit step of heat."""
    mass, stiffness = _heat_matrices(points_mm, triangles)
    result = np.empty_like(values)
    for channel, (sigma, share) in enumerate(zip(SCATTER_MM, SCATTERED, strict=True)):
        # In the plane a step of time t spreads light by a variance of 4 t, 2 t along each axis.
        system = mass + (sigma**2 / 2) * stiffness
        spread, failed = cg(system, mass @ values[:, channel], x0=values[:, channel], rtol=1e-4)
        if failed:
            raise RuntimeError(f"skin: scattering did not converge in channel {channel}")
        result[:, channel] = share * spread + (1 - share) * values[:, channel]
    return result


def _heat_matrices(points: Floats, triangles: Indices) -> tuple[sparse.csr_array, sparse.csr_array]:
    """Return lumped mass and cotangent stiffness of a mesh; obtuse angles count as right ones."""
    count = len(points)
    rows, columns, entries = [], [], []
    for i in range(3):
        a, b, c = (triangles[:, (i + k) % 3] for k in range(3))
        u, v = points[b] - points[a], points[c] - points[a]
        area2 = np.linalg.norm(np.cross(u, v), axis=1)
        cotangent = np.clip((u * v).sum(axis=1) / np.maximum(area2, 1e-9), 0.0, 10.0) / 2
        rows += [b, c, b, c]
        columns += [c, b, b, c]
        entries += [-cotangent, -cotangent, cotangent, cotangent]
    shape = (count, count)
    pairs = (np.concatenate(rows), np.concatenate(columns))
    stiffness = sparse.csr_array(sparse.coo_array((np.concatenate(entries), pairs), shape=shape))
    areas = np.linalg.norm(
        np.cross(
            points[triangles[:, 1]] - points[triangles[:, 0]],
            points[triangles[:, 2]] - points[triangles[:, 0]],
        ),
        axis=1,
    )
    lumped = np.bincount(triangles.ravel(), np.repeat(areas / 6, 3), minlength=count)
    return sparse.csr_array(sparse.diags_array(np.maximum(lumped, 1e-6))), stiffness
