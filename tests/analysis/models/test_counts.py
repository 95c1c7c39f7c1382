"""Counts of answers."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.models.counts import count_answers


def test_every_answer_is_counted_where_it_belongs() -> None:
    counts = count_answers([0, 0, 1, 1, 1], [0, 2, 2, 2, 1], [4, 0, 3, 3, 0], shape=(2, 3, 5))
    assert (counts.people, counts.stimuli, counts.categories) == (2, 3, 5)
    assert counts.total == 5
    assert counts.most_per_person == 3
    assert np.argwhere(counts.table == 2).tolist() == [[1, 2, 3]]
    assert counts.table[0, 0, 4] == counts.table[0, 2, 0] == counts.table[1, 1, 0] == 1


def test_nobody_answered() -> None:
    assert count_answers([], [], [], shape=(2, 3, 5)).total == 0


def test_a_number_outside_is_refused() -> None:
    with pytest.raises(ValueError, match="category: numbers go from 0 to 4; found 1 to 5"):
        count_answers([0, 0], [0, 0], [5, 1], shape=(1, 1, 5))
