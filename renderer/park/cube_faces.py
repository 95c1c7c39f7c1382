"""The six faces of a cube map: where they look, and their texels.

Order and orientation: OpenGL 4.3 core, table 8.18.
"""

from __future__ import annotations

from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

FACES: Final = ("+x", "-x", "+y", "-y", "+z", "-z")
# Columns: right (s grows), down (t grows), forward (major axis).
FACE_AXES: Final = tuple(
    np.array(rows, dtype=float).T
    for rows in (
        [[0, 0, -1], [0, -1, 0], [1, 0, 0]],
        [[0, 0, 1], [0, -1, 0], [-1, 0, 0]],
        [[1, 0, 0], [0, 0, 1], [0, 1, 0]],
        [[1, 0, 0], [0, 0, -1], [0, -1, 0]],
        [[1, 0, 0], [0, -1, 0], [0, 0, 1]],
        [[-1, 0, 0], [0, -1, 0], [0, 0, -1]],
    )
)


def face_view(face: int) -> npt.NDArray[np.float64]:
    """Return the 4 x 4 world-to-camera matrix of a face seen from the origin, t upwards."""
    right, down, forward = FACE_AXES[face].T
    matrix = np.eye(4)
    matrix[:3, :3] = right, down, -forward
    return matrix


def read_face(texture: moderngl.TextureCube, face: int) -> npt.NDArray[np.float32]:
    """Read a face of an RGBA16F cube map as (size, size, 4) float32, rows in texture order."""
    size = texture.size[0]
    pixels = np.frombuffer(texture.read(face), dtype=np.float16)
    return pixels.reshape(size, size, 4).astype(np.float32)


def face_directions(size: int, face: int) -> npt.NDArray[np.float64]:
    """Return the unit directions (size, size, 3) of a face's texels, rows in texture order."""
    centres = (np.arange(size) + 0.5) / size * 2 - 1
    s, t = np.meshgrid(centres, centres)
    directions = np.stack([s, t, np.ones_like(s)], axis=-1) @ FACE_AXES[face].T
    return np.asarray(directions / np.linalg.norm(directions, axis=-1, keepdims=True))
