"""Parts of a body as they are cut from the base mesh, before they are thinned. Pure numpy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices, base_mesh
from renderer.crowd.people import Colour

PARTS: Final = ("skin", "hair", "top", "bottom", "shoes", "eyes", "brows")


@dataclass(frozen=True)
class Piece:
    """A part of a body: base vertices pushed outwards and coloured, thinned to ``target``.

    ``part`` is the one of PARTS whose colour it has. Open edges that lie higher than
    ``turned_in_above_mm`` on the base mesh are turned in to the body.
    """

    part: str
    triangles: Indices
    push_mm: Floats
    surface: Floats
    target: int
    importance: Floats | None = None
    turned_in_above_mm: float | None = None


def group_quads(group: str) -> Indices:
    """Return the quads of a group of the base mesh."""
    return base_mesh().quads[base_mesh().groups[group]]


def group_triangles(group: str) -> Indices:
    """Return the quads' halves, all first ones, then all second ones."""
    quads = group_quads(group)
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def quad_centres(group: str) -> Floats:
    """Return the centre of each triangle's quad: cutting by it follows the mesh's rows."""
    centres = base_mesh().vertices_mm[group_quads(group)].mean(axis=1)
    return np.concatenate([centres, centres])


def flat(colour: Colour, count: int) -> Floats:
    """Return one colour without gloss for so many vertices."""
    return np.tile([*colour, 0.0], (count, 1))
