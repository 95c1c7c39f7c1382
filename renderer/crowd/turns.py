"""Rotations of many things at once, in few calls: what stays of them is computed once. Pure numpy.

Numpy's calls cost more than their arithmetic here, so every step takes all figures together.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

STILL: Final = np.eye(3)


class Hinges:
    """Turns about axes that stay, (..., 3) of any length."""

    def __init__(self, axes: npt.ArrayLike) -> None:
        along = unit(np.asarray(axes, dtype=float))
        # Rodrigues: the part along the axis stays, the rest turns towards what is square to both.
        self._along = along[..., :, None] * along[..., None, :]
        self._across = STILL - self._along
        self._square = -np.cross(along[..., None, :], STILL)

    def turns(self, angles_rad: Floats) -> Floats:
        """Return the rotations (..., 3, 3) by an angle each."""
        return self.turns_of(np.cos(angles_rad), np.sin(angles_rad))

    def turns_of(self, cosine: Floats, sine: Floats) -> Floats:
        """Return the rotations (..., 3, 3) by angles of which cosine and sine are known."""
        across = cosine[..., None, None] * self._across
        return np.asarray(self._along + across + sine[..., None, None] * self._square)


class Pointers:
    """The smallest turns that point directions which stay, (..., 3) of any length, elsewhere."""

    def __init__(self, rest: npt.ArrayLike) -> None:
        self._rest = unit(np.asarray(rest, dtype=float))
        self._half_turn = 2.0 * self._rest[..., :, None] * self._rest[..., None, :] - STILL

    def towards(self, directions: Floats) -> Floats:
        """Return the rotations (..., 3, 3) to unit directions, none of which is the opposite one.

        They are half a turn about the direction at rest, then half a turn about the middle of both.
        """
        middle = self._rest + directions
        share = 2.0 / np.einsum("...k,...k->...", middle, middle)
        about_middle = middle[..., :, None] * (share[..., None] * middle)[..., None, :] - STILL
        return np.asarray(about_middle @ self._half_turn)


def unit(vectors: Floats) -> Floats:
    """Return vectors (..., 3) of length 1."""
    return np.asarray(vectors / np.sqrt(np.einsum("...k,...k->...", vectors, vectors))[..., None])


def applied(turns: Floats, vectors: Floats) -> Floats:
    """Return vectors (..., 3) turned by rotations (..., 3, 3)."""
    return np.asarray(np.einsum("...ij,...j->...i", turns, vectors))


def applied_back(turns: Floats, vectors: Floats) -> Floats:
    """Return vectors (..., 3) as they were before rotations (..., 3, 3) turned them."""
    return np.asarray(np.einsum("...ji,...j->...i", turns, vectors))
