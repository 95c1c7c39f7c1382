"""How much of sun and sky reaches each vertex of a figure past the figure itself, kept on disk."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.rig import skin_vertices
from renderer.cache import cached_array
from renderer.crowd.cast import TEMPLATES
from renderer.crowd.figure import BONES
from renderer.crowd.figures import Figure
from renderer.crowd.occlusion import cone_directions, openness, visibility
from renderer.crowd.stage import Member
from renderer.crowd.troupe import Troupe

Floats = npt.NDArray[np.float64]

SKY_DIRECTIONS: Final = 32
SUN_RADIUS_RAD: Final = 0.05  # softer than the real 0.005, which vertex values cannot carry


def light_shares(figure: Figure, sun: Floats) -> Floats:
    """Return (n, 2): openness to the sky and visibility of the sun, in the pose at time 0.

    In a large crowd (``is_awake``) those who wear the same mesh share its openness, baked as they
    stand facing the viewer: limbs shade the same places whichever way a body is turned.
    """
    towards = f"{np.round(sun, 6).tolist()}"
    if not figure.is_awake:
        key = f"crowd light {figure.member} {figure.seed} {towards}"
        return cached_array(key, lambda: _both(figure, sun)).astype(np.float64)
    wearer = Member(TEMPLATES[figure.member.person.body], "stand")
    mesh = replace(figure, member=wearer, seed=0, scale=1.0)
    sky = cached_array(f"crowd sky {mesh.member}", lambda: _sky(mesh))
    key = f"crowd sun {figure.member} {figure.seed} {towards}"
    lit = cached_array(key, lambda: _lit(figure, sun))
    return np.stack([sky, lit], axis=1).astype(np.float64)


def _both(figure: Figure, sun: Floats) -> Floats:
    return np.stack([_sky(figure), _lit(figure, sun)], axis=1)


def _sky(figure: Figure) -> Floats:
    positions, normals = _posed(figure)
    return openness(positions, normals, triangles=figure.body.triangles, count=SKY_DIRECTIONS)


def _lit(figure: Figure, sun: Floats) -> Floats:
    positions, _ = _posed(figure)
    towards = cone_directions(sun, angle_rad=SUN_RADIUS_RAD)
    return np.asarray(visibility(positions, figure.body.triangles, directions=towards).mean(axis=1))


def _posed(figure: Figure) -> tuple[Floats, Floats]:
    """Return positions in mm and normals (n, 3) at time 0."""
    body = figure.body
    full = np.zeros((len(body.positions_mm), len(BONES)))
    np.add.at(full, (np.arange(len(full))[:, None], body.bones), body.weights)
    transforms = Troupe((figure,)).bones(0.0)[0]
    positions = skin_vertices(body.positions_mm, transforms, weights=full)
    turns = transforms.copy()
    turns[:, :3, 3] = 0.0
    turns[:, :3, :3] /= figure.scale
    return positions, skin_vertices(body.normals, turns, weights=full)
