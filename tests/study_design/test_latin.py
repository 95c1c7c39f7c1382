"""Williams designs: every item at every place, and after every other, equally often."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest

from study.design.latin import williams


@pytest.mark.parametrize("count", range(1, 22))
def test_every_item_stands_equally_often_at_every_place(count: int) -> None:
    rows = williams(count)
    assert len(rows) == (2 * count if count % 2 and count > 1 else count)
    assert all(sorted(row) == list(range(count)) for row in rows)
    seen = Counter((place, item) for row in rows for place, item in enumerate(row))
    assert set(seen.values()) == {len(rows) // count}
    assert len(seen) == count * count


@pytest.mark.parametrize("count", range(2, 22))
def test_every_item_follows_every_other_equally_often(count: int) -> None:
    rows = williams(count)
    followed = Counter(pair for row in rows for pair in pairwise(row))
    assert len(followed) == count * (count - 1)
    assert set(followed.values()) == {len(rows) // count}


def test_four_items_give_the_square_of_the_textbooks() -> None:
    assert williams(4) == ((0, 1, 3, 2), (1, 2, 0, 3), (2, 3, 1, 0), (3, 0, 2, 1))


def test_an_order_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="count: 0; an order needs at least one item"):
        williams(0)
