"""Single answers out of counts, and what the model says of each once its person is known.

A person's effects are drawn from what the person's own answers leave open about them. Under the
model a person and their answers then stand together as if the person had been drawn first, so each
answer given its person follows the model's probabilities, independently of all others.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.counts import Counts
from analysis.models.likelihood import cells, posteriors
from analysis.models.ordinal import OrdinalModel
from analysis.models.quadrature import Grid

Floats = NDArray[np.float64]
Integers = NDArray[np.intp]
_BLOCK: Final = 2_000_000  # numbers per block of people x nodes


@dataclass(frozen=True)
class Answers:
    """One entry for each answer (n_answers,): numbers of person, stimulus and category, from 0."""

    person: Integers
    stimulus: Integers
    category: Integers


def answers_of(counts: Counts) -> Answers:
    """Return the answers behind counts, by person, then stimulus, then category."""
    places = np.nonzero(counts.table)
    often = counts.table[places].astype(np.intp)
    person, stimulus, category = (np.repeat(place, often) for place in places)
    return Answers(person, stimulus, category)


def probabilities(
    model: OrdinalModel,
    parameters: Floats,
    counts: Counts,
    grid: Grid,
    *,
    answers: Answers,
    rng: np.random.Generator,
    times: int = 1,
) -> Iterator[Floats]:
    """Draw every person ``times``; yield each answer's probabilities (n_answers, n_categories)."""
    log_p = cells(model, parameters, grid).log_p
    for nodes in _drawn(log_p, counts, grid, rng=rng, times=times):
        yield np.exp(log_p[answers.stimulus, :, nodes[answers.person]])


def _drawn(
    log_p: Floats, counts: Counts, grid: Grid, *, rng: np.random.Generator, times: int
) -> Integers:
    """Draw people's nodes (times, n_people) from their probabilities given people's answers."""
    flat = log_p.reshape(-1, log_p.shape[2])
    own = counts.table.reshape(counts.people, -1)
    step = max(1, _BLOCK // flat.shape[1])
    found = np.empty((times, counts.people), dtype=np.intp)
    for start in range(0, counts.people, step):
        rows = slice(start, start + step)
        below = np.cumsum(posteriors(own[rows], flat, grid)[0], axis=1)
        for own_nodes in found:
            level = rng.random((len(below), 1)) * below[:, -1:]
            own_nodes[rows] = (below < level).sum(axis=1)
    return found
