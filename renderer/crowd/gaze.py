"""Where the crowd's eyes are, where they look, and how large they are on a picture. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.camera import IRIS_DIAMETER_MM, LIMBUS_Z_MM
from renderer.crowd.figure import BONES
from renderer.crowd.figures import Figure
from renderer.crowd.sockets import Socket
from renderer.crowd.turns import Floats, Hinges
from renderer.eye.anatomy import GLOBE_RADIUS_MM

HEAD: Final = BONES.index("head")
YAW_DEG: Final = 28.0  # farther aside people turn their heads
PITCH_DEG: Final = 16.0
_YAW: Final = Hinges([0.0, 1.0, 0.0])
_PITCH: Final = Hinges([-1.0, 0.0, 0.0])  # upwards
_BEHIND: Final = -0.1  # cosine: eyes that look this far away from the camera are not seen


@dataclass(frozen=True)
class CrowdGaze:
    """All eyes of figures, the viewer's left then right of each: (e, ...) arrays."""

    figure: npt.NDArray[np.int64]
    centres_mm: Floats
    radii_mm: Floats
    scale: Floats
    targets_mm: Floats  # NaN where the eyes look where the head points

    @classmethod
    def of(cls, figures: Sequence[Figure], pairs: Sequence[tuple[Socket, Socket]]) -> CrowdGaze:
        """Collect the eyes of figures from their bodies' sockets."""
        nowhere = (np.nan,) * 3
        scale = np.repeat([figure.scale for figure in figures], 2)
        return cls(
            figure=np.repeat(np.arange(len(figures)), 2),
            centres_mm=np.array([socket.centre_mm for pair in pairs for socket in pair]),
            radii_mm=np.array([socket.radius_mm for pair in pairs for socket in pair]) * scale,
            scale=scale,
            targets_mm=np.repeat([f.member.looks_at or nowhere for f in figures], 2, axis=0),
        )

    def placed(self, bones: Floats) -> tuple[Floats, Floats]:
        """Place the eyes for everybody's bones (f, b, 4, 4).

        Returns eye to world (e, 4, 4) without scale, and yaw and pitch (e, 2) in degrees of each
        eye in its head, to the viewer's right and up.
        """
        heads = bones[self.figure, HEAD]
        turn = heads[:, :3, :3] / self.scale[:, None, None]
        centre = np.einsum("eij,ej->ei", heads[:, :3, :3], self.centres_mm) + heads[:, :3, 3]
        aside_deg = self._aside(turn, centre)
        yaw, pitch = np.radians(aside_deg).T
        turn = turn @ _YAW.turns(yaw) @ _PITCH.turns(pitch)
        found = np.zeros((len(turn), 4, 4))
        found[:, :3, :3], found[:, 3, 3] = turn, 1.0
        # Our globe lies as far forwards in the wider socket as its front does.
        found[:, :3, 3] = centre + turn[:, :, 2] * (self.radii_mm - GLOBE_RADIUS_MM)[:, None]
        return found, aside_deg

    def _aside(self, turn: Floats, centre: Floats) -> Floats:
        """Return yaw and pitch (e, 2) in the head that bring the gaze to its target, if it can."""
        local = np.einsum("eji,ej->ei", turn, self.targets_mm - centre)
        local = np.where(np.isnan(local), [0.0, 0.0, 1.0], local)
        x, y, z = local.T
        yaw = np.clip(np.degrees(np.arctan2(x, z)), -YAW_DEG, YAW_DEG)
        pitch = np.clip(np.degrees(np.arctan2(y, np.hypot(x, z))), -PITCH_DEG, PITCH_DEG)
        return np.stack([yaw, pitch], axis=1)


def iris_px(
    eye_to_world: Floats,
    *,
    view_matrix: npt.NDArray[np.floating],
    projection: npt.NDArray[np.floating],
    lines: int,
) -> Floats:
    """Return the irises' diameters (e,) on a picture in pixels; 0 for eyes that cannot be seen.

    Measured as ``renderer.camera.iris_px`` does: the larger axis of the limbus.
    """
    view = np.asarray(view_matrix, dtype=float)
    limbus = eye_to_world[:, :3, 3] + LIMBUS_Z_MM * eye_to_world[:, :3, 2]
    seen = limbus @ view[:3, :3].T + view[:3, 3]
    depth = -seen[:, 2]
    focal_px = 0.5 * lines * float(projection[1][1])
    towards = np.einsum("ei,ei->e", eye_to_world[:, :3, 2] @ view[:3, :3].T, -seen)
    is_facing = towards > _BEHIND * np.linalg.norm(seen, axis=1)
    tan_x, tan_y = 1.0 / float(projection[0][0]), 1.0 / float(projection[1][1])
    room = 2 * GLOBE_RADIUS_MM
    inside = (np.abs(seen[:, 0]) < depth * tan_x + room) & (
        np.abs(seen[:, 1]) < depth * tan_y + room
    )
    shown = is_facing & inside & (depth > room)
    return np.where(shown, focal_px * IRIS_DIAMETER_MM / np.maximum(depth, room), 0.0)
