"""How many people a power takes: between the numbers simulated, never beyond them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtr

from analysis.power.needed import needed_people

PEOPLE = (10, 20, 40, 80)


def power(people: float) -> float:
    return float(ndtr(0.45 * np.sqrt(people) - 1.645))


def test_the_power_of_a_normal_test_is_read_exactly() -> None:
    exact = ((1.645 + 0.8416) / 0.45) ** 2  # 30.5 people
    own = [power(n) for n in PEOPLE]
    found = needed_people(PEOPLE, own, low=[p - 0.05 for p in own], high=[p + 0.05 for p in own])
    assert found.people == int(np.ceil(exact)) == 31
    assert found.low is not None
    assert found.high is not None
    assert 24 <= found.low < 31 < found.high <= 40
    assert not found.is_at_most


@pytest.mark.parametrize(
    ("own", "people", "is_at_most"), [((0.1, 0.2, 0.3, 0.4), None, False), ((0.9,) * 4, 10, True)]
)
def test_nothing_is_said_beyond_the_numbers_simulated(
    own: tuple[float, ...], people: int | None, *, is_at_most: bool
) -> None:
    found = needed_people(PEOPLE, own, low=own, high=own)
    assert (found.people, found.low, found.is_at_most) == (people, None, is_at_most)


def test_power_that_falls_again_by_chance_counts_where_it_stays() -> None:
    own = (0.7, 0.82, 0.78, 0.9)
    assert 40 < (needed_people(PEOPLE, own, low=own, high=own).people or 0) < 80


def test_what_cannot_be_concluded_takes_no_number() -> None:
    empty = (np.nan,) * 4
    assert needed_people(PEOPLE, empty, low=empty, high=empty).people is None
