"""Trials of a LoD beside the best one, as the curves of what is noticed and preferred take them."""

from __future__ import annotations

import pandas as pd

from analysis.curves.law import LogSizes, sizes_by_lod
from analysis.curves.sizes import Measure, with_size

EQUAL = ""
"""Stands for the lesser LoD where both eyes were equal."""


def against_best(comparisons: pd.DataFrame, measure: Measure, best: str) -> pd.DataFrame:
    """Return the trials of a LoD beside the best, and of equal LoDs, that count and have a size.

    ``lod`` is the lesser one, EQUAL for equal pairs; ``is_right`` says whether the best stood
    right.
    """
    rows = with_size(comparisons[~comparisons["is_practice"]], measure)
    left, right = rows["left_lod"], rows["right_lod"]
    lesser = left.where(right == best, right).where(left != right, EQUAL)
    is_wanted = (left == right) | (left == best) | (right == best)
    return rows.assign(lod=lesser, is_right=right == best)[is_wanted]


def at_sizes(rows: pd.DataFrame, best: str) -> tuple[pd.DataFrame, LogSizes]:
    """Return the rows of ``against_best`` of LoDs shown at two sizes, with those sizes.

    Equal pairs stay, as one stimulus: their size is 0.
    """
    is_equal = rows["lod"] == EQUAL
    sizes = sizes_by_lod(rows["lod"][~is_equal], rows["size"][~is_equal], best=best)
    kept = rows[is_equal | rows["lod"].isin(sizes)].copy()
    kept["size"] = kept["size"].where(kept["lod"] != EQUAL, 0.0)
    return kept, sizes
