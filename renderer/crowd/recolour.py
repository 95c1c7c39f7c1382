"""Other clothes, hair and skin on a mesh that is there already: one mesh serves many people.

Pure numpy.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from renderer.crowd.face_parts import brow_colour
from renderer.crowd.figure import Body
from renderer.crowd.people import Person
from renderer.crowd.pieces import PARTS


def recoloured(body: Body, wearer: Person, *, person: Person) -> Body:
    """Return the ``wearer``'s body in a ``person``'s colours, shades and patterns kept."""
    if person == wearer:
        return body
    surface = body.surface.copy()
    old, new = _palette(wearer), _palette(person)
    for part in ("skin", "hair", "top", "bottom", "shoes", "brows"):
        rows = body.parts == PARTS.index(part)
        surface[rows, :3] *= np.array(new[part]) / np.array(old[part])
    is_iris = (body.parts == PARTS.index("eyes")) & (surface[:, :3] == wearer.iris).all(axis=1)
    surface[is_iris, :3] = person.iris
    return replace(body, surface=np.clip(surface, 0.0, 1.0))


def _palette(person: Person) -> dict[str, tuple[float, ...]]:
    return {
        "skin": person.skin,
        "hair": person.hair,
        "top": person.top,
        "bottom": person.bottom,
        "shoes": person.shoes,
        "brows": brow_colour(person),
    }
