"""Draws from what a fit leaves open: every interval and every share of draws is made from them."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.fitting import OrdinalFit

Floats = NDArray[np.float64]
DRAWS: Final = 4000
_FARTHEST: Final = 50.0  # on the latent scale nothing lies there
_GREATEST_LOG: Final = 4.0  # two people's draws of a spread have no end: exp(exp(50)) is no number


def draw(found: OrdinalFit, rng: np.random.Generator, *, people: int) -> Floats:
    """Draw parameters (DRAWS, n_parameters) from Student's t about a fit."""
    drawn = draw_about(found.parameters, found.covariance, rng, people=people)
    logs = [kind.startswith("log") for kind in found.model.kinds]
    return np.where(logs, np.minimum(drawn, _GREATEST_LOG), drawn)


def draw_about(
    parameters: Floats, covariance: Floats, rng: np.random.Generator, *, people: int
) -> Floats:
    """Draw from Student's t about parameters (n,), with one degree of freedom less than people."""
    freedom = max(people - 1, 1)
    values, vectors = np.linalg.eigh(covariance)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    normal = rng.standard_normal((DRAWS, len(values))) @ root.T
    away = normal / np.sqrt(rng.chisquare(freedom, (DRAWS, 1)) / freedom)
    return np.asarray(np.clip(parameters + away, -_FARTHEST, _FARTHEST))
