"""What others answer: shares of many are met, the top is that of a grid, nobody counts twice."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtr

from analysis.screening.others import LAPSE, others_of

CUTS = np.array([-1.0, 0.0, 1.2])


def expected(middles: list[float], total: float, *, scatter: float = 0.7) -> np.ndarray:
    below = ndtr((CUTS - np.array(middles)[:, None]) / scatter)
    return total * np.diff(np.column_stack([0 * below[:, 0], below, 1 + 0 * below[:, 0]]), axis=1)


def test_many_answers_are_met() -> None:
    own = expected([-0.8, 0.0, 1.0], 5000.0)
    counts = np.stack([own, own, own])
    found = np.exp(others_of(counts).log_shares(0, np.zeros(1))[0])
    pooled = counts.sum(axis=(0, 1)) / counts.sum()
    wanted = (1 - LAPSE) * own / 5000.0 + LAPSE * pooled
    assert found == pytest.approx(wanted, abs=0.05)
    assert found.sum(axis=1) == pytest.approx(1.0)


def test_lenience_moves_shares_up() -> None:
    counts = np.stack([expected([-0.5, 0.5], 50.0)] * 4)
    shares = np.exp(others_of(counts).log_shares(1, np.array([-1.0, 0.0, 1.0])))
    mean = shares @ np.arange(4)
    assert (np.diff(mean, axis=0) > 0.5).all()


def test_a_persons_own_answers_do_not_count_among_the_others() -> None:
    like = np.round(expected([-0.8, 0.0, 1.0], 8.0))
    one, other = (np.stack([own, like, like, like]) for own in (like, like[::-1]))
    mine = [others_of(counts).log_shares(0, np.zeros(1)) for counts in (one, other)]
    theirs = [others_of(counts).log_shares(1, np.zeros(1)) for counts in (one, other)]
    assert mine[1] == pytest.approx(mine[0], abs=0.02)
    assert np.abs(theirs[1] - theirs[0]).max() > 0.2


def test_places_nobody_else_saw_are_taken_for_ordinary() -> None:
    counts = np.zeros((3, 2, 4))
    counts[:, 0] = [2.0, 5.0, 5.0, 1.0]
    counts[0, 1] = [0.0, 0.0, 0.0, 6.0]
    found = others_of(counts)
    assert found.middle[0, 1] == pytest.approx(0.0, abs=0.02)
    assert np.isfinite(found.log_shares(0, np.zeros(1))).all()
