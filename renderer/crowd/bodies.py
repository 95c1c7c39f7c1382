"""Bodies from the disk cache, and the figures that wear them. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.rig import Rig
from renderer.cache import cached_arrays
from renderer.crowd.cast import TEMPLATES
from renderer.crowd.figure import BONES, Body, build_body
from renderer.crowd.figures import Figure
from renderer.crowd.people import Person
from renderer.crowd.recolour import recoloured
from renderer.crowd.sockets import awake
from renderer.crowd.stage import Member

_FLOAT_FIELDS: Final = ("positions_mm", "normals", "surface", "weights", "heads_mm", "tails_mm")
_WHOLE_FIELDS: Final = ("bones", "triangles", "outline", "parts", "parents")


def build_figures(members: Sequence[Member], *, is_awake: bool = False) -> tuple[Figure, ...]:
    """Return the members with their meshes, numbered for shared buffers."""
    worn = dict.fromkeys(member.person.body for member in members)
    bodies = {name: cached_body(TEMPLATES[name]) for name in worn}
    if is_awake:
        bodies = {name: awake(body) for name, body in bodies.items()}
    figures: list[Figure] = []
    first = 0
    for seed, member in enumerate(members):
        template = TEMPLATES[member.person.body]
        body = recoloured(bodies[template.name], template, person=member.person)
        scale = member.person.stature_mm / template.stature_mm
        figures.append(Figure(member, body, first, seed, scale, is_awake))
        first += len(body.positions_mm)
    return tuple(figures)


def cached_body(person: Person) -> Body:
    """Return a person's mesh from the disk cache, or build and keep it."""
    kept = cached_arrays(f"crowd body {person}", lambda: _body_arrays(build_body(person)))
    floats = {name: kept[name].astype(np.float64) for name in _FLOAT_FIELDS}
    whole = {name: kept[name].astype(np.int64) for name in _WHOLE_FIELDS}
    # Bodies are skinned by their four strongest bones, so the rig needs no weights of its own.
    rig = Rig(
        BONES,
        whole.pop("parents"),
        floats.pop("heads_mm"),
        floats.pop("tails_mm"),
        np.zeros((0, len(BONES)), dtype=np.float32),
    )
    return Body(
        positions_mm=floats["positions_mm"],
        normals=floats["normals"],
        surface=floats["surface"],
        weights=floats["weights"],
        bones=whole["bones"],
        triangles=whole["triangles"],
        outline=whole["outline"],
        parts=whole["parts"],
        rig=rig,
    )


def _body_arrays(body: Body) -> dict[str, npt.NDArray[np.generic]]:
    names = (*_FLOAT_FIELDS, *_WHOLE_FIELDS)
    return {name: getattr(body if hasattr(body, name) else body.rig, name) for name in names}
