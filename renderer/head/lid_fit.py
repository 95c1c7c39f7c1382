"""Eyelids fitted to our globe in any pose: a fine skin patch from the rims to the face around them.

Pure numpy, patch space (see ``lid_pose``). MakeHuman's lids enclose a globe of 15 mm radius; here
they are replaced by lids that are modelled anatomically, ring by ring around the fissure, and melt
into the face's surface. A column of the rings keeps its place on the lid while the lid moves.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices
from renderer.head.lid_lap import lap_over
from renderer.head.lid_outline import blur_ring, canthus_nearness, end_distance, outward_from
from renderer.head.lid_pose import STRAIGHT, LidPose
from renderer.head.lid_rims import LATERAL_MM, MEDIAL_MM, rim, rim_shares, smooth_step, soft_max
from renderer.head.lid_skin import Columns, lower_skin, upper_skin
from renderer.head.lid_socket import DrawnFace, Socket

TUCK_MM: Final = 1.6  # from the inner edge back to the patch's innermost ring
OFF_GLOBE_TUCK_MM: Final = 2.0  # more of it at the canthi, where nothing is close behind
MARGIN_MM: Final = 1.75  # lid thickness at the rim
MARGIN_TURN: Final = (0.5, 0.8)  # of the margin against the globe's normal, lower and upper lid
MEETING_MM: Final = 3.5  # lids that are nearer to each other turn their margins face to face
ENDING: Final = (0.0, 0.9, 1.8, 2.7)  # of the last rings, in mm beyond the outline
SETTLED: Final = (0.25, 0.6, 0.9, 1.0, 1.0, 1.0, 1.0)  # how far the last rings obey the face
LIFTED: Final = (0.35, 0.7, 1.0, 1.0, 1.0)  # how far the rings inside it keep off a lower place
LIFT_MM: Final = 0.6  # how softly
AROUND: Final = 176
ALONG: Final = 48
EDGE_ROW: Final = 3  # of the lids' inner edge


@dataclass(frozen=True)
class LidPatch:
    """The skin around one eye in patch space, a grid of rings: (around, along, 3) in mm.

    Row 0 lies inside the globe, the last row under the face's skin. ``rim_row`` is the row of the
    lid's outer edge, where lashes grow. ``is_upper`` (around,) runs from 0 on the lower lid to 1
    on the upper; ``across_mm`` (around, along) is the way along the skin from the inner edge,
    EDGE_ROW.
    """

    points_mm: Floats
    is_upper: Floats
    across_mm: Floats
    rim_row: int
    pose: LidPose = STRAIGHT


def fit_lids(socket: Socket, pose: LidPose = STRAIGHT) -> LidPatch:
    """Build the patch of one eye on its socket."""
    controls, rim_control = _control_net(socket, pose)
    basis, places = _spline_basis(controls.shape[1], ALONG)
    points = np.einsum("wk,tkc->twc", basis, controls)
    rim_row = int(np.argmin(np.abs(places - rim_control)))
    points = lap_over(points, rim_row)
    steps = np.linalg.norm(np.diff(points, axis=1), axis=2)
    across = np.concatenate([np.zeros((AROUND, 1)), np.cumsum(steps, axis=1)], axis=1)
    return LidPatch(
        points, upper_share(), across - across[:, EDGE_ROW : EDGE_ROW + 1], rim_row, pose
    )


def inner_edge(pose: LidPose) -> Floats:
    """Return the rims as one ring (around, 3) from the temple over the upper lid and back."""
    upper = rim(_column_shares(is_upper=True), pose, is_upper=True)
    lower = rim(_column_shares(is_upper=False), pose, is_upper=False)
    ring = np.concatenate([upper, lower])
    near = np.exp(-(((ring[:, :1] - LATERAL_MM[0]) / 0.7) ** 2))  # no edge in the outer corner
    return np.asarray(ring + near * (blur_ring(ring, samples=1.5) - ring))


def upper_share() -> Floats:
    """Return how much each column belongs to the upper lid, 1 to 0, soft at the canthi."""
    is_upper = np.repeat([1.0, 0.0], AROUND // 2)
    for _ in range(14):
        is_upper = (np.roll(is_upper, 1) + 2 * is_upper + np.roll(is_upper, -1)) / 4
    return is_upper


@functools.cache
def _column_shares(*, is_upper: bool) -> Floats:
    """Return the columns' places on one rim: closer at the canthi, where the ring turns."""
    shares = rim_shares(801)
    xy = rim(shares, STRAIGHT, is_upper=is_upper)[:, :2]
    middles = (xy[1:] + xy[:-1]) / 2
    canthus = np.minimum(*(np.linalg.norm(middles - at, axis=1) for at in (LATERAL_MM, MEDIAL_MM)))
    steps = np.linalg.norm(np.diff(xy, axis=0), axis=1) * (
        1 + 1.6 * np.exp(-((canthus / 1.8) ** 2))
    )
    way = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    wanted = np.arange(AROUND // 2) / (AROUND // 2)
    return np.asarray(np.interp(1 - wanted if is_upper else wanted, way, shares))


def _control_net(socket: Socket, pose: LidPose) -> tuple[Floats, int]:
    """Return the spline's control points (around, controls, 3) and the outer edge's control."""
    straight = inner_edge(STRAIGHT)
    inner = inner_edge(pose)
    is_upper = upper_share()
    outward = outward_from(straight[:, :2])
    canthus = canthus_nearness(straight[:, :2])
    rows = _margin_rows(inner, outward, canthus=canthus)
    rim_control = len(rows) - 1
    columns = Columns(
        edge=rows[-1],
        outward=outward,
        canthus=canthus,
        lowered_mm=straight[:, 1] - inner[:, 1],
        end_mm=end_distance(rows[-1], outward),
        pose=pose,
        face=DrawnFace(socket).height,
    )
    upper, lower = upper_skin(columns), lower_skin(columns)
    rows += [
        u * is_upper[:, None] + low * (1 - is_upper[:, None])
        for u, low in zip(upper, lower, strict=True)
    ]
    rows += [columns.on_face(columns.end_mm + beyond) for beyond in ENDING]
    net = np.stack(rows, axis=1)
    for row in range(rim_control + 1, net.shape[1]):
        # Rings lose the rim's corners on their way out.
        net[:, row] = blur_ring(net[:, row], samples=min(1.0 + 0.6 * (row - rim_control), 8.0))
    # Lids lie on the face and never dip below it: the dip would be a ring of shade around the eye.
    for row, share in enumerate(LIFTED, start=net.shape[1] - len(ENDING) - len(LIFTED)):
        face = socket.height(net[:, row, :2])
        net[:, row, 2] += share * (soft_max(face, net[:, row, 2], LIFT_MM) - net[:, row, 2])
    for row, share in enumerate(SETTLED, start=net.shape[1] - len(SETTLED)):
        net[:, row, 2] += share * (socket.height(net[:, row, :2]) - net[:, row, 2])
    return net, rim_control


def _margin_rows(inner: Floats, outward: Floats, *, canthus: Floats) -> list[Floats]:
    """Return the rings from inside the globe over the margin to the lid's outer edge."""
    radial = inner / np.linalg.norm(inner, axis=1, keepdims=True)
    margin = _margin_direction(inner, radial, outward=outward, canthus=canthus)
    thick = MARGIN_MM * (1 - 0.55 * canthus) * (1.0 - 0.1 * upper_share())
    edge = inner + margin * thick[:, None]
    # The first rings run straight back into the globe, or at the canthi under the conjunctiva: no
    # light shines between lid and globe, and from the front nothing of them shows.
    back = np.array([0.0, 0.0, 1.0])
    off = np.clip(np.linalg.norm(inner, axis=1, keepdims=True) - 12.2, 0.0, 1.0)
    rows = [
        inner - (TUCK_MM + OFF_GLOBE_TUCK_MM * off) * back,
        inner - 0.15 * (0.5 * radial + 0.5 * back),
    ]
    rows += [inner + margin * (thick * share)[:, None] for share in (0.12, 0.45, 0.8)]
    rows.append(edge + np.column_stack([outward * 0.1, np.zeros(AROUND)]))
    return rows


def _margin_direction(inner: Floats, radial: Floats, *, outward: Floats, canthus: Floats) -> Floats:
    """Return where the margins face, (around, 3): forwards, the lower up, the upper down."""
    is_upper, one = upper_share(), np.ones(AROUND)
    apart = smooth_step(_opening(inner) / MEETING_MM)
    # The upper lid's margin looks down and a little forwards: half a millimetre of it shows.
    rise = MARGIN_TURN[0] * (1 - is_upper) + MARGIN_TURN[1] * is_upper
    rise = 1.0 + (rise - 1.0) * apart
    turned = radial * np.column_stack([0.65 * one, rise, one])
    corner = np.column_stack([outward * (0.35 * apart)[:, None], 0.85 * one])
    margin = corner * canthus[:, None] + turned * (1 - canthus[:, None])
    margin = blur_ring(margin, samples=2.0)
    return np.asarray(margin / np.linalg.norm(margin, axis=1, keepdims=True))


def _opening(ring: Floats) -> Floats:
    """Return how far apart the rims are at each column, in mm."""
    half = AROUND // 2
    upper, lower = ring[half - 1 :: -1], ring[half:]
    x = ring[:, 0]
    height = np.interp(x, *upper[:, :2].T) - np.interp(x, *lower[:, :2].T)
    return np.asarray(np.maximum(height, 0.0))


def _spline_basis(controls: int, rows: int) -> tuple[Floats, Floats]:
    """Return the clamped uniform cubic B-spline basis (rows, controls) and the rows' places."""
    places = np.linspace(0.0, controls - 1.0, rows)
    basis = np.zeros((rows, controls + 4))
    base = np.floor(places).astype(int)
    t = places - base
    weights = (
        (1 - t) ** 3 / 6,
        (3 * t**3 - 6 * t**2 + 4) / 6,
        (-3 * t**3 + 3 * t**2 + 3 * t + 1) / 6,
        t**3 / 6,
    )
    for offset, weight in enumerate(weights):
        basis[np.arange(rows), base + offset] += weight  # column 0 is one before the first control
    inner = basis[:, 1 : controls + 1].copy()
    inner[:, 0] += basis[:, 0]
    inner[:, -1] += basis[:, controls + 1 :].sum(axis=1)
    return inner, places


def grid_quads(around: int, along: int) -> Indices:
    """Return the quads (n, 4) of a grid that closes on itself around, seen from outside."""
    i, j = np.meshgrid(np.arange(around), np.arange(along - 1), indexing="ij")
    n = (i + 1) % around
    corners = [i * along + j, i * along + j + 1, n * along + j + 1, n * along + j]
    return np.stack(corners, axis=-1).reshape(-1, 4)
