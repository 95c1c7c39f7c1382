"""Parts of an index buffer that are drawn: fewer draws where they lie side by side. Pure."""

from __future__ import annotations

from collections.abc import Iterable

Range = tuple[int, int]


def adjoined(ranges: Iterable[Range]) -> list[Range]:
    """Return ranges (first, count) as few: one that begins where the last ends is joined to it."""
    joined: list[Range] = []
    end = None
    for first, count in ranges:
        if first == end:
            start, length = joined[-1]
            joined[-1] = start, length + count
        else:
            joined.append((first, count))
        end = first + count
    return joined
