"""What a person of the crowd is made of: skin, clothes and hair as pieces of the base mesh.

Pure numpy. Pieces are cut on the base mesh by the place of its quads, so the same cut fits every
build; millimetres, +z forwards.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices, base_mesh
from renderer.body.phenotype import target_offsets
from renderer.crowd.hems import open_edges
from renderer.crowd.people import Colour, Person

# Height of the hairline on the base mesh over depth: nape, behind and above the ear, temple, brow.
_HAIRLINE: Final = (
    (-60.0, 0.0, 12.0, 30.0, 60.0, 95.0, 120.0, 145.0),
    (668.0, 690.0, 742.0, 742.0, 768.0, 788.0, 796.0, 800.0),
)
NECK_MM: Final = 500.0  # edges of clothes that lie higher are collars
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
    shift_mm: Floats | None = None
    is_two_sided: bool = False
    turned_in_above_mm: float | None = None


def pieces(person: Person) -> list[Piece]:
    """Return the parts that a person is made of."""
    mesh = base_mesh()
    base = mesh.vertices_mm
    n = len(base)
    body, tights = _triangles("body"), _triangles("helper-tights")
    centre = _quad_centres("body")
    skin = np.tile([*person.skin, 0.0], (n, 1))
    _paint_face(skin, base)
    is_head = (centre[:, 1] > 530) & (np.abs(centre[:, 0]) < 125)
    is_hand = _beyond_sleeve(centre, person) > -25
    cloth = _quad_centres("helper-tights")
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
    found = [
        Piece("skin", body[is_head], still, skin, 1900, _face_detail(base)),
        Piece("skin", body[is_hand], still, skin, 480),
        Piece(
            "top",
            tights[is_top & is_covered],
            loose,
            _flat(person.top, n),
            1000,
            turned_in_above_mm=NECK_MM,
        ),
        Piece("bottom", tights[~is_top & ~is_shoe], trousers, _flat(person.bottom, n), 560),
        Piece("shoes", tights[is_shoe], np.full(n, 9.0), _flat(person.shoes, n), 160),
        _scalp(person, base, body),
    ]
    if person.has_long_hair:
        found.append(_long_hair(person, base))
    return found


def _beyond_sleeve(places: Floats, person: Person) -> Floats:
    """Return how far places of the base mesh lie beyond the sleeve's end along the arm, in mm."""
    axis = np.array([0.66, -0.75, 0.0] if person.has_short_sleeves else [0.504, -0.481, 0.716])
    end = -150.0 if person.has_short_sleeves else 268.0
    x, y, z = np.abs(places[:, 0]), places[:, 1], places[:, 2]
    along = np.stack([x, y, z], axis=1) @ axis - end
    return np.where((x > 200) & (y > 100), along, -1e3)


def _is_collar(rows: int = 2) -> npt.NDArray[np.bool_]:
    """Whether a triangle of the clothes helper lies in its uppermost rows around the neck."""
    quads = _quads("helper-tights")
    edges = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, counts = np.unique(edges, axis=0, return_counts=True)
    reached = np.unique(edges[counts == 1])
    reached = reached[base_mesh().vertices_mm[reached, 1] > 540]
    is_within = np.zeros(len(quads), dtype=bool)
    for _ in range(rows):
        is_within |= np.isin(quads, reached).any(axis=1)
        reached = np.unique(quads[is_within])
    return np.concatenate([is_within, is_within])


def _quads(group: str) -> Indices:
    return base_mesh().quads[base_mesh().groups[group]]


def _triangles(group: str) -> Indices:
    quads = _quads(group)
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _quad_centres(group: str) -> Floats:
    """Return the centre of each triangle's quad: cutting by it follows the mesh's rows."""
    centres = base_mesh().vertices_mm[_quads(group)].mean(axis=1)
    return np.concatenate([centres, centres])


def _face_detail(base: Floats) -> Floats:
    """Return how much each vertex matters: eyes, brows and mouth most, skull and neck least."""
    x, y, z = np.abs(base[:, 0]), base[:, 1], base[:, 2]
    detail = np.where((y > 640) & (z > 70), 5.0, 0.6)
    detail[(y > 715) & (y < 760) & (x < 60) & (z > 85)] = 30.0
    detail[(y > 635) & (y < 695) & (x < 40) & (z > 90)] = 40.0
    return detail


def _flat(colour: Colour, count: int) -> Floats:
    return np.tile([*colour, 0.0], (count, 1))


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


def _scalp(person: Person, base: Floats, body: Indices) -> Piece:
    """Return short hair: the scalp lifted off the skull, thinner towards the hairline."""
    centre = _quad_centres("body")
    row = np.interp(centre[:, 2], *_HAIRLINE)
    triangles = body[(centre[:, 1] > row) & (np.abs(centre[:, 0]) < 90)]
    rim = np.unique(open_edges(triangles))
    shift = _snap(base, rim)
    # Where the line runs up behind the ear its height says little: hair is thin near its rim.
    within = np.asarray(cKDTree(base[rim] + shift[rim]).query(base)[0])
    within[rim] = 0.0
    lumps = 1 + 0.12 * np.sin(base @ [0.19, 0.07, 0.13]) * np.sin(base @ [-0.11, 0.23, 0.17])
    push = (1.5 + 11.5 * np.clip(within / 45, 0, 1) ** 0.7) * lumps
    streaks = 1 + 0.18 * np.sin(base @ [0.9, 0.2, 0.35])
    surface = _flat(person.hair, len(base))
    surface[:, :3] *= streaks[:, None]
    return Piece("hair", triangles, push, surface, 420, shift_mm=shift, turned_in_above_mm=0.0)


def _snap(base: Floats, rim: Indices) -> Floats:
    """Return shifts (n, 3) that bring the rim of the hair on the hairline: no jags."""
    shift = np.zeros_like(base)
    for _ in range(4):  # the shortest way there, sideways where the line is steep
        y, z = (base[rim] + shift[rim]).T[1:]
        above = y - np.interp(z, *_HAIRLINE)
        slope = (np.interp(z + 1, *_HAIRLINE) - np.interp(z - 1, *_HAIRLINE)) / 2
        step = -above / (1 + slope * slope)
        shift[rim, 1] += step
        shift[rim, 2] -= slope * step
    length = np.linalg.norm(shift, axis=1, keepdims=True)
    return np.asarray(shift * np.minimum(1.0, 25.0 / np.maximum(length, 1e-9)))


def _long_hair(person: Person, base: Floats) -> Piece:
    triangles, centre = _triangles("helper-hair"), _quad_centres("helper-hair")
    frames_face = (centre[:, 2] < 62) | (centre[:, 1] > 800)
    kept = (centre[:, 1] > 520) & frames_face
    surface = _flat(person.hair, len(base))
    surface[:, :3] *= (1 + 0.2 * np.sin(base @ [0.5, 0.0, 0.5]))[:, None]
    return Piece("hair", triangles[kept], np.full(len(base), 2.0), surface, 300, is_two_sided=True)
