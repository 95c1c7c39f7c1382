"""Latin squares of orders: every item once at each place, and once right after each other item.

Pure arithmetic on numbers from 0; it knows neither clips nor people.
"""

from __future__ import annotations

from functools import cache

Row = tuple[int, ...]


@cache
def williams(count: int) -> tuple[Row, ...]:
    """Return a Williams design for ``count`` items: ``count`` rows, twice as many if it is odd.

    Over all rows every item stands equally often at every place, and follows every other item
    equally often (Williams 1949, "Experimental designs balanced for the estimation of residual
    effects of treatments"): whatever one clip leaves behind falls on all others alike.
    """
    if count < 1:
        raise ValueError(f"count: {count}; an order needs at least one item")
    first = [0]
    for step in range(1, count):
        # 0, 1, n-1, 2, n-2, ...: the differences of neighbours are all different.
        first.append((step + 1) // 2 if step % 2 else count - step // 2)
    rows = tuple(tuple((item + shift) % count for item in first) for shift in range(count))
    # With an odd number the differences come twice or never; the rows read backwards mend that.
    return rows if count % 2 == 0 or count == 1 else (*rows, *(row[::-1] for row in rows))
