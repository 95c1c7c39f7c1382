"""The face around one eye without its lids: the surface that fitted lids melt into.

Pure numpy and scipy, patch space (see ``lid_pose``).
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.interpolate import RBFInterpolator

from renderer.body.makehuman import Floats

# Where the face gives way for the canthi: place, height of the skin there, reach, all in mm.
CANTHUS_PITS: Final = (((-17.4, -2.2), 8.0, 7.5), ((13.4, 0.5), 5.6, 7.0))


class Socket:
    """The face's surface z(x, y) around one eye, lids taken away and the gap bridged smoothly."""

    def __init__(self, points_mm: Floats) -> None:
        """Take points (n, 3) of the face's skin in patch space; those on its lids are dropped."""
        x, y, _ = points_mm.T
        # Below, the lids reach down to the cheek: the hollow around MakeHuman's globe goes too.
        up, down = (y - 1.0) / 10.0, (y + 0.5) / 14.5
        on_lids = ((x - 0.5) / 21.0) ** 2 + np.where(y > 0, up, down) ** 2 < 1.0
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


class DrawnFace:
    """The socket's surface, drawn back to where the lids meet at the canthi."""

    def __init__(self, socket: Socket) -> None:
        self._socket = socket
        self._pits = []
        for (x, y), z, reach in CANTHUS_PITS:
            surplus = float(socket.height(np.array([x, y]))) - z
            self._pits.append((x, y, max(surplus, 0.0), reach))

    def height(self, xy: Floats) -> Floats:
        """Return z (...,) at points (..., 2)."""
        z = self._socket.height(xy)
        for x, y, depth, reach in self._pits:
            r2 = ((xy[..., 0] - x) ** 2 + (xy[..., 1] - y) ** 2) / reach**2
            z = z - depth * np.clip(1 - r2, 0, 1) ** 2
        return z
