"""How a difference from the best LoD grows with the log2 x of the iris's size.

Whether anyone notices it is limited by what the eye resolves: a sigmoid, A Phi((x - m) / w). How
much less real it looks has no such law, but is much like one: a sigmoid that may be bent at every
octave, by a tenth or two, and never falls. docs/power.md compares the two.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

Floats = NDArray[np.float64]
BENT_PRIORS: Final[Mapping[str, tuple[float, float]]] = {
    "log_height": (0.0, 1.5),
    "log_width": (float(np.log(2.0)), 0.8),
    "bend": (0.0, 0.15),
}
"""Where realism is lost: over about two octaves, less certain than what is noticed. By simulation:
bends of 0.15 halve the bias of one sigmoid, those of 0.3 and more cost limits by size; a height as
certain as that of what is noticed shows a loss where there is none."""

_HEIGHT: Final = 50.0  # greater differences than any answer could tell
_APART: Final = 1.0  # octaves between knots, at least


@dataclass(frozen=True)
class Shape:
    """One LoD's difference: A Phi((x - m) / w) exp(b(x)), b straight between ``knots`` (n_knots,).

    Without knots it is a sigmoid. The parameters are log A, m, log w and b at every knot.
    """

    knots: tuple[float, ...] = ()

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """What each parameter is, for the priors."""
        return ("log_height", "middle", "log_width", *("bend",) * len(self.knots))

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The parameters' names, without the LoD's."""
        return (*self.kinds[:3], *(f"bend{j}" for j in range(len(self.knots))))

    def named(self, lod: str) -> tuple[str, ...]:
        """Return the parameters' names with the LoD's."""
        return tuple(f"{name}:{lod}" for name in self.names)

    def difference(self, parameters: Floats, x: Floats) -> Floats:
        """Return it at rising log2 sizes (n_x,) for rows of parameters (n, n_names): (n, n_x)."""
        height, middle, width = parameters[:, :3].T
        z = (x - middle[:, None]) / np.exp(width)[:, None]
        found = np.minimum(np.exp(height), _HEIGHT)[:, None] * ndtr(z)
        if self.knots:  # a bend may turn it down where it is nearly flat
            found = np.maximum.accumulate(found * np.exp(parameters[:, 3:] @ self.hats(x).T), 1)
        return np.asarray(found)

    def hats(self, x: Floats) -> Floats:
        """Return how much each knot has to say at x (n_x, n_knots)."""
        parts = [np.interp(x, self.knots, unit) for unit in np.eye(len(self.knots))]
        return np.column_stack([np.zeros((len(x), 0)), *parts])


def bent_over(sizes: Floats) -> Shape:
    """Return the shape that may be bent, for a LoD shown at these log2 sizes, at least two."""
    first, last = float(sizes.min()), float(sizes.max())
    knots = [first]
    for size in np.sort(sizes).tolist():
        if size - knots[-1] >= _APART and last - size >= _APART / 2:
            knots.append(size)
    return Shape((*knots, last))


@dataclass(frozen=True)
class Shaped:
    """A shape as an ordinal model takes it: eta at log2 sizes ``x``, 0 where it is not ``shown``.

    Both are (n_stimuli,).
    """

    shape: Shape
    x: Floats
    shown: NDArray[np.bool_]
    lod: str

    @property
    def stimuli(self) -> int:
        """How many stimuli there are."""
        return len(self.x)

    @property
    def names(self) -> tuple[str, ...]:
        """The shape's, with the LoD's."""
        return self.shape.named(self.lod)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The shape's."""
        return self.shape.kinds

    def eta(self, parameters: Floats) -> Floats:
        """Return the difference, bends and all."""
        factor, z, _ = self._parts(parameters)
        return factor * ndtr(z)

    def jacobian(self, parameters: Floats) -> Floats:
        """Return the derivatives by log A, m, log w and every bend."""
        factor, z, width = self._parts(parameters)
        value, steep = factor * ndtr(z), factor * np.exp(-0.5 * z * z) / np.sqrt(2 * np.pi)
        first = np.column_stack([value, -steep / width, -steep * z])
        return np.hstack([first, value[:, None] * self._hats])

    @cached_property
    def _hats(self) -> Floats:
        return self.shape.hats(self.x)

    def _parts(self, parameters: Floats) -> tuple[Floats, Floats, float]:
        width = float(np.exp(parameters[2]))
        factor = np.where(self.shown, np.exp(parameters[0] + self._hats @ parameters[3:]), 0.0)
        return factor, (self.x - parameters[1]) / width, width
