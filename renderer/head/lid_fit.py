"""Eyelids fitted to our globe: a fine skin patch from the rims to the face around them.

Pure numpy. MakeHuman's lids enclose a globe of 15 mm radius; here they are replaced by lids that
are modelled anatomically, ring by ring around the fissure, and melt into the face's surface.
Patch space is eye space with the temple at +x, whichever eye it is: millimetres, origin at the
globe's centre, +z straight ahead, +y up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.interpolate import RBFInterpolator

from renderer.body.makehuman import Floats, Indices
from renderer.head.lid_rims import LATERAL_MM, MEDIAL_MM, rim_curves, smooth_step

TUCK_MM: Final = 11.0  # radius of the patch's innermost ring
MARGIN_MM: Final = 1.75  # lid thickness at the rim
MARGIN_TURN: Final = (0.5, 0.1)  # of the margin against the globe's normal, lower and upper lid
OUTLINE_MM: Final = (24.5, 22.5, 17.5, 17.0)  # patch ends: temple, nose, up, down of (0, 0)
# Lift in mm of the outermost rings over the face, and how far they obey.
ENDING: Final = ((0.0, 0.6), (0.0, 1.0), (0.0, 1.0), (0.0, 1.0), (0.0, 1.0), (0.0, 1.0))
AROUND: Final = 168
ALONG: Final = 46


@dataclass(frozen=True)
class LidPatch:
    """The skin around one eye in patch space, a grid of rings: (around, along, 3) in mm.

    Row 0 lies inside the globe, the last row under the face's skin. ``rim_row`` is the row of the
    lid's outer edge, where lashes grow. ``is_upper`` (around,) runs from 0 on the lower lid to 1
    on the upper; ``across_mm`` (around, along) is the way along the skin from the inner edge.
    """

    points_mm: Floats
    is_upper: Floats
    across_mm: Floats
    rim_row: int


class Socket:
    """The face's surface z(x, y) around one eye, lids taken away and the gap bridged smoothly."""

    def __init__(self, points_mm: Floats) -> None:
        """Take points (n, 3) of the face's skin in patch space; those on its lids are dropped."""
        x, y, _ = points_mm.T
        on_lids = ((x + 1.5) / 19.0) ** 2 + ((y - np.where(y > 0, 1.0, -0.5)) / 10.0) ** 2 < 1.0
        kept = _thinned(points_mm[~on_lids], spacing_mm=1.7)
        self._surface = RBFInterpolator(kept[:, :2], kept[:, 2], smoothing=0.02)

    def height(self, xy: Floats) -> Floats:
        """Return z (...,) at points (..., 2)."""
        return np.asarray(self._surface(xy.reshape(-1, 2))).reshape(xy.shape[:-1])


def _thinned(points: Floats, *, spacing_mm: float) -> Floats:
    """Keep one point per square: the interpolator's cost grows with the cube of their number."""
    cells = np.floor(points[:, :2] / spacing_mm).astype(int)
    _, first = np.unique(cells, axis=0, return_index=True)
    return np.asarray(points[np.sort(first)])


def fit_lids(socket: Socket) -> LidPatch:
    """Build the patch of one eye on its socket."""
    inner, is_upper = _loop()
    controls, rim_control = _control_net(inner, is_upper, socket)
    basis, places = _spline_basis(controls.shape[1], ALONG)
    points = np.einsum("wk,tkc->twc", basis, controls)
    steps = np.linalg.norm(np.diff(points, axis=1), axis=2)
    across = np.concatenate([np.zeros((AROUND, 1)), np.cumsum(steps, axis=1)], axis=1)
    rim_row = int(np.argmin(np.abs(places - rim_control)))
    return LidPatch(points, is_upper, across - across[:, 2:3], rim_row)


def _loop() -> tuple[Floats, Floats]:
    """Return the inner edge, evenly spaced, from the temple over the upper lid and back."""
    upper, lower = rim_curves(samples=513)
    ring = np.concatenate([upper[::-1], lower[1:]])
    lid = np.concatenate([np.ones(len(upper)), np.zeros(len(lower) - 1)])
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ring, axis=0), axis=1))])
    wanted = (np.arange(AROUND) / AROUND) * lengths[-1]
    points = np.column_stack([np.interp(wanted, lengths, ring[:, axis]) for axis in range(3)])
    is_upper = np.interp(wanted, lengths, lid)
    for _ in range(10):  # soften the change of lid over some 2 mm at the canthi
        is_upper = (np.roll(is_upper, 1) + 2 * is_upper + np.roll(is_upper, -1)) / 4
    return points, is_upper


def _control_net(inner: Floats, is_upper: Floats, socket: Socket) -> tuple[Floats, int]:
    """Return the spline's control points (around, controls, 3) and the outer edge's control."""
    xy = inner[:, :2]
    outward = _outward(xy)
    canthus = _canthus_nearness(xy)
    up, one = is_upper[:, None], np.ones(AROUND)
    radial = inner / np.linalg.norm(inner, axis=1, keepdims=True)
    margin = np.concatenate([outward * 0.35, np.full((AROUND, 1), 0.85)], axis=1)
    # The upper lid's margin looks down: from the front it hides behind the lid's outer edge.
    rise = MARGIN_TURN[0] * (1 - is_upper) + MARGIN_TURN[1] * is_upper
    turned = radial * np.column_stack([0.65 * one, rise, one])
    margin = margin * canthus[:, None] + turned * (1 - canthus[:, None])
    margin /= np.linalg.norm(margin, axis=1, keepdims=True)
    thick = MARGIN_MM * (1 - 0.45 * canthus) * (1.0 - 0.1 * is_upper)
    edge = inner + margin * thick[:, None]
    # The first ring lies inside the globe: no light shines between lid and globe.
    # Off the globe, at the canthi, it runs straight back under the conjunctiva.
    off = np.clip(np.linalg.norm(inner, axis=1, keepdims=True) - 12.5, 0.0, 1.0)
    tuck = radial * TUCK_MM * (1 - off) + (inner - [0.0, 0.0, 3.5]) * off
    rows = [tuck, inner - radial * 0.15]
    rows += [inner + margin * (thick * share)[:, None] for share in (0.12, 0.45, 0.8)]
    rim_control = len(rows)
    rows.append(edge + np.concatenate([outward * 0.1, np.zeros((AROUND, 1))], axis=1))
    upper_rows = _upper_skin(edge, outward, canthus, socket)
    lower_rows = _lower_skin(edge, outward, canthus, socket)
    rows += [u * up + low * (1 - up) for u, low in zip(upper_rows, lower_rows, strict=True)]
    net = np.stack(rows, axis=1)
    for row in range(rim_control + 1, net.shape[1]):
        # Rings lose the rim's corners on their way out.
        net[:, row] = _blur_ring(net[:, row], samples=min(1.0 + 0.9 * (row - rim_control), 9.0))
    _settle(net, socket)
    return net, rim_control


def _settle(net: Floats, socket: Socket) -> None:
    """Lay the outermost controls back on the face after smoothing."""
    for row, (lift, share) in enumerate(ENDING, start=net.shape[1] - len(ENDING)):
        height = socket.height(net[:, row, :2]) + lift
        net[:, row, 2] += (height - net[:, row, 2]) * share


def _blur_ring(values: Floats, *, samples: float) -> Floats:
    """Smooth (around, k) along the ring by a Gaussian of ``samples`` standard deviation."""
    frequency = np.fft.rfftfreq(len(values))[:, None]
    gain = np.exp(-2 * (np.pi * frequency * samples) ** 2)
    return np.asarray(np.fft.irfft(np.fft.rfft(values, axis=0) * gain, n=len(values), axis=0))


def _outward(xy: Floats) -> Floats:
    """Return the frontal directions (n, 2) in which the rings grow from the fissure."""
    direction = _blur_ring(_outline(xy) - xy, samples=5.0)
    return np.asarray(direction / np.linalg.norm(direction, axis=1, keepdims=True))


def _outline(xy: Floats) -> Floats:
    """Return where each ring position ends: an egg around the eye."""
    temple, nose, up, down = OUTLINE_MM
    centre = np.array([-1.5, -0.4])
    direction = (xy - centre) / np.array([14.5, 5.5])
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    x = np.where(direction[:, 0] > 0, temple, nose) * direction[:, 0]
    y = np.where(direction[:, 1] > 0, up, down) * direction[:, 1]
    return np.column_stack([x, y])


def _canthus_nearness(xy: Floats) -> Floats:
    """Return 1 at the canthi falling to 0 some 5 mm from them."""
    nearest = np.minimum(
        np.linalg.norm(xy - np.array(LATERAL_MM), axis=1) / 4.5,
        np.linalg.norm(xy - np.array(MEDIAL_MM), axis=1) / 5.5,
    )
    return 1.0 - smooth_step(nearest)


def _skin_point(edge: Floats, outward: Floats, distance: Floats, lift: Floats) -> Floats:
    """Return points on the pretarsal skin: the globe's curvature, continued from the edge."""
    xy = edge[:, :2] + outward * distance[:, None]
    radius = np.linalg.norm(edge, axis=1)
    falls = np.sqrt(np.maximum(radius**2 - (xy**2).sum(1), 9.0))
    starts = np.sqrt(np.maximum(radius**2 - (edge[:, :2] ** 2).sum(1), 9.0))
    return np.column_stack([xy, edge[:, 2] + falls - starts + lift])


def _face_point(
    edge: Floats, outward: Floats, distance: Floats, *, socket: Socket, lift: Floats
) -> Floats:
    xy = edge[:, :2] + outward * distance[:, None]
    return np.column_stack([xy, socket.height(xy) + lift])


def _upper_skin(edge: Floats, outward: Floats, canthus: Floats, socket: Socket) -> list[Floats]:
    """Lashes' edge, tarsal platform, crease, overhanging fold, then the face up to the brow."""
    end = np.linalg.norm(_end_points(edge, outward) - edge[:, :2], axis=1)
    x = edge[:, 0]
    one = np.ones(len(edge))
    platform = (2.7 - 0.8 * smooth_step((x - 2.0) / 10.0) - 0.7 * smooth_step((-x - 8.0) / 8.0)) * (
        1 - 0.45 * canthus
    )
    fold = 2.1 * (1 - 0.7 * canthus)
    rows = [_skin_point(edge, outward, d * one, -0.02 * one) for d in (0.35, 0.8)]
    rows += [_skin_point(edge, outward, platform * share, 0.10 * one) for share in (0.5, 0.78)]
    rows.append(_skin_point(edge, outward, platform * 0.97, -0.15 * one))
    crease = _skin_point(edge, outward, platform * 1.05, -0.40 * one)
    rows.append(crease)
    lip = crease.copy()
    lip[:, :2] -= outward * (0.10 * fold)[:, None]
    rows.append(lip + np.column_stack([0 * x, 0 * x, 0.55 * fold]))
    rows.append(lip + np.column_stack([*(outward * 0.35).T, 1.0 * fold]))
    after = crease + np.column_stack([*(outward * 1.4).T, 1.25 * fold])
    rows.append(after)
    rest = end - platform * 1.05
    for share, bulge in ((0.2, 2.2), (0.36, 2.5), (0.53, 1.6), (0.7, 0.7), (0.87, 0.1)):
        face = _face_point(
            edge,
            outward,
            platform * 1.05 + rest * share,
            socket=socket,
            lift=bulge * (1 - canthus),
        )
        # A gentle slope up to the brow: a steep one would hang in its own shadow.
        way = min((share + 0.06) / 0.96, 1.0)
        blend = (1 - (1 - way) ** 1.6) * one
        local = after[:, 2] + (face[:, 2] - after[:, 2]) * blend
        face[:, 2] = local
        rows.append(face)
    return rows + _ending(edge, outward, end, socket)


def _lower_skin(edge: Floats, outward: Floats, canthus: Floats, socket: Socket) -> list[Floats]:
    """Lashes' edge, the roll of the muscle beneath, a shallow furrow, then the cheek."""
    end = np.linalg.norm(_end_points(edge, outward) - edge[:, :2], axis=1)
    one = np.ones(len(edge))
    away = 1 - 0.8 * canthus
    rows = [
        _skin_point(edge, outward, d * one, lift * one) for d, lift in ((0.35, 0.0), (0.8, 0.08))
    ]
    near = ((1.5, 0.3), (2.3, 0.42), (3.2, 0.48), (4.1, 0.48), (5.0, 0.45), (5.9, 0.42), (6.9, 0.4))
    squeeze = np.minimum(0.45 + 0.55 * away, 0.5 * end / 6.9)
    for distance, lift in near:
        d = distance * squeeze
        skin = _skin_point(edge, outward, d, lift * away)
        face = _face_point(edge, outward, d, socket=socket, lift=lift * away)
        blend = smooth_step((distance * (1 + 2.0 * canthus) - 0.5) / 7.0)[:, None]
        rows.append(skin * (1 - blend) + face * blend)
    first = 6.9 * squeeze
    for share, lift in ((0.18, 0.35), (0.36, 0.25), (0.54, 0.12), (0.72, 0.02), (0.88, 0.0)):
        d = first + (end - first) * share
        rows.append(_face_point(edge, outward, d, socket=socket, lift=lift * away))
    return rows + _ending(edge, outward, end, socket)


def _end_points(edge: Floats, outward: Floats) -> Floats:
    """Return where straight lines from the rim meet the outline."""
    reach = np.linspace(3.0, 30.0, 541)
    line = edge[:, None, :2] + outward[:, None, :] * reach[None, :, None]
    temple, nose, up, down = OUTLINE_MM
    x = line[..., 0] / np.where(line[..., 0] > 0, temple, nose)
    y = line[..., 1] / np.where(line[..., 1] > 0, up, down)
    first = np.argmax(x * x + y * y >= 1.0, axis=1)
    return np.asarray(edge[:, :2] + outward * reach[first][:, None])


def _ending(edge: Floats, outward: Floats, end: Floats, socket: Socket) -> list[Floats]:
    """Run on the face's surface to the outline, then sink below it."""
    return [
        _face_point(edge, outward, end + beyond, socket=socket, lift=np.zeros(len(edge)))
        for beyond in (0.0, 0.9, 1.8, 2.7)
    ]


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
