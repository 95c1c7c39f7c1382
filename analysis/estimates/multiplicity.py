"""P values adjusted for how many decisions they belong to.

A missing p value stays missing and does not count.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def holm(p: ArrayLike) -> Floats:
    """Adjust p values so that the chance of any false alarm keeps its level (Holm 1979).

    The j-th smallest of m becomes max_{i<=j} (m - i + 1) p_(i), at most 1.
    """
    values, order, known = _sorted(p)
    m = order.size
    steps = np.maximum.accumulate(values[order] * (m - np.arange(m)))
    return _back(steps, order, known)


def _sorted(p: ArrayLike) -> tuple[Floats, NDArray[np.intp], NDArray[np.bool_]]:
    given = np.asarray(p, dtype=float)
    if given.ndim != 1:
        raise ValueError(f"p values: one row of numbers is accepted, found shape {given.shape}")
    known = np.isfinite(given)
    values = given[known]
    if ((values < 0) | (values > 1)).any():
        raise ValueError(
            f"p values lie between 0 and 1; found {values.min():g} to {values.max():g}"
        )
    return values, np.argsort(values, kind="stable"), known


def _back(adjusted: Floats, order: NDArray[np.intp], known: NDArray[np.bool_]) -> Floats:
    own = np.empty_like(adjusted)
    own[order] = np.minimum(adjusted, 1.0)
    result: Floats = np.full(known.shape, np.nan)
    result[known] = own
    return result
