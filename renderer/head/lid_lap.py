"""The fold at the outer corner of the eye, where the upper lid laps over the lower. Pure numpy.

Patch space (see ``lid_pose``); columns run around the fissure from the temple over the upper lid.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.head.lid_rims import smooth_step

LAP_COLUMN: Final = -5  # the fold's line: a little below the corner's own column
LAP_MM: Final = 4.5  # how far it runs on towards the temple
LAP_RISE_MM: Final = 0.25  # of the upper lid's skin over the line
LAP_DEPTH_MM: Final = 0.22  # of the groove under it
LAP_OVER_MM: Final = 0.3  # how far the upper lid's skin comes down over the lower's


def lap_over(points: Floats, rim_row: int) -> Floats:
    """Return a lid's points (around, along, 3) in mm with the upper skin lapped over the lower.

    The fold runs on from the corner towards the temple and a little down, where it fades. Nothing
    moves at the lid's inner edge; ``rim_row`` is the outer edge's.
    """
    around, along, _ = points.shape
    column = np.arange(around)
    above = np.where(column < around // 2, column, column - around) - LAP_COLUMN
    way = np.linalg.norm(points[:, rim_row:, :2] - points[:, rim_row : rim_row + 1, :2], axis=2)
    way = np.concatenate([np.zeros((around, rim_row)), way], axis=1)
    fade = (1 - smooth_step((way - 0.5) / LAP_MM)) * smooth_step(np.arange(along) / rim_row)
    lip = np.exp(-((np.maximum(above - 1.5, 0.0) / 7.0) ** 2)) * smooth_step((above + 1.0) / 2.5)
    groove = np.exp(-(((above + 2.0) / 2.5) ** 2))
    lapped = points.copy()
    lapped[..., 2] += fade * (LAP_RISE_MM * lip - LAP_DEPTH_MM * groove)[:, None]
    lapped[..., 1] -= fade * (LAP_OVER_MM * lip)[:, None]
    return lapped
