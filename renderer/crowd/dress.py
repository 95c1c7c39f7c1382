"""What a person of the crowd is made of: skin and clothes as pieces of the base mesh.

Pure numpy. Pieces are cut on the base mesh by the place of its quads, so the same cut fits every
build; millimetres, +z forwards.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, base_mesh
from renderer.body.phenotype import target_offsets
from renderer.crowd.people import Person
from renderer.crowd.pieces import Piece, flat, group_quads, group_triangles, quad_centres

NECK_MM: Final = 500.0  # edges of clothes that lie higher are collars


def pieces(person: Person) -> list[Piece]:
    """Return the parts that a person is made of."""
    mesh = base_mesh()
    base = mesh.vertices_mm
    n = len(base)
    body, tights = group_triangles("body"), group_triangles("helper-tights")
    centre = quad_centres("body")
    skin = np.tile([*person.skin, 0.0], (n, 1))
    _paint_face(skin, base)
    is_head = (centre[:, 1] > 530) & (np.abs(centre[:, 0]) < 125)
    is_hand = _beyond_sleeve(centre, person) > -25
    cloth = quad_centres("helper-tights")
    is_arm = (np.abs(cloth[:, 0]) > 200) & (cloth[:, 1] > 200)
    # The mesh's rows dip towards the middle, and the hem should not.
    hem = person.hem_y_mm - 35.0 * (np.abs(cloth[:, 0]) < 50)
    is_top = is_arm | (cloth[:, 1] > hem)
    is_covered = (_beyond_sleeve(cloth, person) < 0) & ~_is_collar()
    is_shoe = cloth[:, 1] < -765
    still = np.zeros(n)
    # The helper stands off the neck as it is.
    loose = 9.0 + 5.0 * np.clip((300 - base[:, 1]) / 300, 0, 1)
    loose -= 6.0 * np.clip((base[:, 1] - 530) / 50, 0, 1)
    trousers = 5.0 + 7.0 * np.clip((-250 - base[:, 1]) / 300, 0, 1)
    return [
        Piece("skin", body[is_head], still, skin, 1900, _face_detail(base)),
        Piece("skin", body[is_hand], still, skin, 480),
        Piece(
            "top",
            tights[is_top & is_covered],
            loose,
            flat(person.top, n),
            1000,
            turned_in_above_mm=NECK_MM,
        ),
        Piece("bottom", tights[~is_top & ~is_shoe], trousers, flat(person.bottom, n), 560),
        Piece("shoes", tights[is_shoe], np.full(n, 9.0), flat(person.shoes, n), 160),
    ]


def _beyond_sleeve(places: Floats, person: Person) -> Floats:
    """Return how far places of the base mesh lie beyond the sleeve's end along the arm, in mm."""
    axis = np.array([0.66, -0.75, 0.0] if person.has_short_sleeves else [0.504, -0.481, 0.716])
    end = -150.0 if person.has_short_sleeves else 268.0
    x, y, z = np.abs(places[:, 0]), places[:, 1], places[:, 2]
    along = np.stack([x, y, z], axis=1) @ axis - end
    return np.where((x > 200) & (y > 100), along, -1e3)


def _is_collar(rows: int = 2) -> npt.NDArray[np.bool_]:
    """Whether a triangle of the clothes helper lies in its uppermost rows around the neck."""
    quads = group_quads("helper-tights")
    edges = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, counts = np.unique(edges, axis=0, return_counts=True)
    reached = np.unique(edges[counts == 1])
    reached = reached[base_mesh().vertices_mm[reached, 1] > 540]
    is_within = np.zeros(len(quads), dtype=bool)
    for _ in range(rows):
        is_within |= np.isin(quads, reached).any(axis=1)
        reached = np.unique(quads[is_within])
    return np.concatenate([is_within, is_within])


def _face_detail(base: Floats) -> Floats:
    """Return how much each vertex matters: eyes, brows and mouth most, skull and neck least."""
    x, y, z = np.abs(base[:, 0]), base[:, 1], base[:, 2]
    detail = np.where((y > 640) & (z > 70), 5.0, 0.6)
    detail[(y > 715) & (y < 760) & (x < 60) & (z > 85)] = 30.0
    detail[(y > 635) & (y < 695) & (x < 40) & (z > 90)] = 40.0
    return detail


def _paint_face(skin: Floats, base: Floats) -> None:
    """Colour lips, lid rims and flushed cheeks on the base mesh's vertices."""
    x, y, z = np.abs(base[:, 0]), base[:, 1], base[:, 2]
    moved = target_offsets(
        {"mouth/mouth-upperlip-volume-incr": 1.0, "mouth/mouth-lowerlip-volume-incr": 1.0}
    )
    amount = np.linalg.norm(moved, axis=1)
    lips = np.clip((amount - 1.2) / 1.6, 0, 1) * np.clip((21 - x) / 4, 0, 1) * 0.6
    skin[:, :3] += lips[:, None] * (skin[:, :3] * [0.92, 0.50, 0.52] - skin[:, :3])
    flush = 0.25 * np.exp(-(((x - 48) / 18) ** 2 + ((y - 695) / 20) ** 2)) * (z > 60)
    skin[:, :3] *= 1 - flush[:, None] * [0.0, 0.5, 0.4]
    rim = (np.hypot(np.hypot(x - 30.8, y - 728.4), z - 124.5) < 16.2) & (z > 120)
    skin[rim, :3] += 0.5 * (np.array([0.02, 0.014, 0.012]) - skin[rim, :3])
