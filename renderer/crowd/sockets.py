"""Where a body's eyes are and how far its lids leave them open. Pure numpy.

Bodies carry painted caps (``renderer.crowd.face_parts``) on MakeHuman's globes, wider than ours;
``shaders/crowd_eye.vert`` lays our globe over them, arc for arc, and so do the rims here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.body.makehuman import Floats, Indices
from renderer.crowd.figure import Body
from renderer.crowd.pieces import PARTS
from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.lids import LidRims

STEP_MM: Final = 0.5  # between the places where lids are looked for
HALF_WIDTH_MM: Final = 14.0
RIM_LIFT_MM: Final = 0.6  # rims lie on the globe, as thick as a margin's inner half
_NEAR_MM: Final = 34.0
# MakeHuman's people look out under heavy lids. An upper lid covers a millimetre or two of the iris.
AWAKE_MM: Final = 3.9  # height of the upper rim over the gaze
_LID_MM: Final = (12.0, 6.5)  # reach of what moves with it, across and upwards
_CLEAR_MM: Final = 0.5  # between lid and globe


@dataclass(frozen=True)
class Socket:
    """One eye of a body at rest: its globe, the cap's vertices, the lids' rims in eye space."""

    centre_mm: Floats
    radius_mm: float
    rows: Indices
    rims: LidRims


def sockets(body: Body) -> tuple[Socket, Socket]:
    """Return the viewer's left and right eye of a body that faces the viewer."""
    rows = np.flatnonzero(body.parts == PARTS.index("eyes"))
    left, right = sorted(np.split(rows, 2), key=lambda part: body.positions_mm[part, 0].mean())
    return _socket(body, left), _socket(body, right)


def awake(body: Body) -> Body:
    """Return a body whose upper lids are raised until the irises show as in people awake."""
    positions = body.positions_mm.copy()
    is_skin = body.parts == PARTS.index("skin")
    for socket in sockets(body):
        x, y, z = (positions - socket.centre_mm).T
        top = float(socket.rims.upper_mm[:, 1].max())
        moved = np.exp(-((x / _LID_MM[0]) ** 2) - ((y - top) / _LID_MM[1]) ** 2)
        moved *= is_skin & (z > 0) & (y > top - 4.0)
        local = np.column_stack([x, y + max(AWAKE_MM - top, 0.0) * moved, z])
        away = np.linalg.norm(local, axis=1, keepdims=True)
        outside = np.maximum(away, (socket.radius_mm + _CLEAR_MM) * (moved > 0.05)[:, None])
        positions = socket.centre_mm + local * outside / np.maximum(away, 1e-9)
    return replace(body, positions_mm=positions)


def _socket(body: Body, rows: Indices) -> Socket:
    places, normals = body.positions_mm[rows], body.normals[rows]
    # The cap is its normals, scaled and moved.
    apart = np.linalg.norm(places[-1] - places[0]) / np.linalg.norm(normals[-1] - normals[0])
    radius = float(apart)
    centre = places[0] - radius * normals[0]
    return Socket(centre, radius, rows, _rims(body, centre, radius))


def _rims(body: Body, centre_mm: Floats, radius_mm: float) -> LidRims:
    """Return the edges of what no skin hides from in front, in eye space."""
    axis = np.arange(-HALF_WIDTH_MM, HALF_WIDTH_MM + STEP_MM / 2, STEP_MM)
    x, y = np.meshgrid(axis, axis)
    z = np.sqrt(np.maximum(radius_mm**2 - x * x - y * y, 0.0))
    is_open = ~_covered(body, centre_mm, np.stack([x, y, z], axis=-1).reshape(-1, 3))
    is_open = is_open.reshape(x.shape) & (z > 0.3 * radius_mm)
    labels, count = ndimage.label(is_open)
    sizes = ndimage.sum_labels(is_open, labels, np.arange(1, count + 1))
    opening = labels == 1 + int(np.argmax(sizes))
    columns = np.flatnonzero(opening.any(axis=0))
    tops = [float(axis[np.flatnonzero(opening[:, k])[-1]]) + STEP_MM / 2 for k in columns]
    lows = [float(axis[np.flatnonzero(opening[:, k])[0]]) - STEP_MM / 2 for k in columns]
    across = axis[columns]
    return LidRims(
        upper_mm=_on_globe(across, np.array(tops), radius_mm),
        lower_mm=_on_globe(across, np.array(lows), radius_mm),
    )


def _covered(body: Body, centre_mm: Floats, places: Floats) -> npt.NDArray[np.bool_]:
    """Return (n,) whether skin lies before places (n, 3) around the globe's centre, along z."""
    corners = body.positions_mm[body.triangles] - centre_mm
    is_cap = body.parts[body.triangles[:, 0]] == PARTS.index("eyes")
    near = (np.abs(corners) < _NEAR_MM).all(axis=(1, 2)) & ~is_cap & (corners[..., 2].max(1) > 0)
    covered = np.zeros(len(places), dtype=bool)
    for a, b, c in corners[near]:
        twice = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if abs(twice) < 1e-9:
            continue
        dx, dy = places[:, 0] - a[0], places[:, 1] - a[1]
        v = (dx * (c[1] - a[1]) - dy * (c[0] - a[0])) / twice
        w = (dy * (b[0] - a[0]) - dx * (b[1] - a[1])) / twice
        depth = a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2])
        covered |= (v >= 0) & (w >= 0) & (v + w <= 1) & (depth > places[:, 2])
    return covered


def _on_globe(x: Floats, y: Floats, radius_mm: float) -> Floats:
    """Carry places of the socket (n,) over to our globe, arc for arc."""
    around = np.maximum(np.hypot(x, y), 1e-9)
    angle = np.arcsin(np.minimum(around / radius_mm, 1.0)) * radius_mm / GLOBE_RADIUS_MM
    out = (GLOBE_RADIUS_MM + RIM_LIFT_MM) * np.sin(np.minimum(angle, np.pi / 2))
    z = (GLOBE_RADIUS_MM + RIM_LIFT_MM) * np.cos(np.minimum(angle, np.pi / 2))
    return np.column_stack([x * out / around, y * out / around, z])
