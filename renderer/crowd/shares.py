"""How much of sun and sky reaches each vertex of a figure past the figure itself, kept on disk."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.rig import skin_vertices
from renderer.cache import cached_arrays
from renderer.crowd.figure import BONES
from renderer.crowd.figures import Figure
from renderer.crowd.occlusion import cone_directions, openness, visibility

Floats = npt.NDArray[np.float64]

SKY_DIRECTIONS: Final = 32
SUN_RADIUS_RAD: Final = 0.05  # softer than the real 0.005, which vertex values cannot carry


def light_shares(figure: Figure, sun: Floats) -> Floats:
    """Return (n, 2): openness to the sky and visibility of the sun, in the pose at time 0."""
    who = f"{figure.member} {figure.seed} {figure.is_awake}"
    key = f"crowd light {who} {np.round(sun, 6).tolist()}"
    shares = cached_arrays(key, lambda: {"shares": _light_shares(figure, sun)})["shares"]
    return shares.astype(np.float64)


def _light_shares(figure: Figure, sun: Floats) -> Floats:
    body = figure.body
    full = np.zeros((len(body.positions_mm), len(BONES)))
    np.add.at(full, (np.arange(len(full))[:, None], body.bones), body.weights)
    transforms = figure.bones(0.0)
    positions = skin_vertices(body.positions_mm, transforms, weights=full)
    turns = transforms.copy()
    turns[:, :3, 3] = 0.0
    turns[:, :3, :3] /= figure.scale
    normals = skin_vertices(body.normals, turns, weights=full)
    sky = openness(positions, normals, triangles=body.triangles, count=SKY_DIRECTIONS)
    towards = cone_directions(sun, angle_rad=SUN_RADIUS_RAD)
    lit = visibility(positions, body.triangles, directions=towards).mean(axis=1)
    return np.stack([sky, lit], axis=1)
