"""What was observed at each size: the points beside a curve, without any model of size."""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.descriptive.means import t_interval
from analysis.descriptive.shares import wilson

COLUMNS = ("size", "value", "low", "high", "answers")


def share_points(sizes: pd.Series, hits: pd.Series) -> pd.DataFrame:
    """Return the share of hits at every size with Wilson's 95 % interval.

    ``sizes`` are log2; the points' are not.
    """
    rows = []
    for size, own in hits.groupby(coarse(sizes)):
        count, total = int(own.sum()), len(own)
        low, high = wilson(count, total)
        rows.append((2.0 ** float(str(size)), count / total, low, high, total))
    return pd.DataFrame(rows, columns=list(COLUMNS))


def loss_points(rated: pd.DataFrame, lod: str, best: str) -> pd.DataFrame:
    """Return how far ``lod`` was rated below ``best`` at every size, with t intervals over people.

    ``rated`` has participant, lod, rating and size, a log2.
    """
    rows = rated.assign(size=coarse(rated["size"]))
    means = rows.groupby(["size", "participant", "lod"])["rating"].mean().unstack("lod")
    if not {lod, best} <= set(means.columns):
        return pd.DataFrame(columns=list(COLUMNS))
    given = rows[rows["lod"] == lod].groupby("size").size()
    loss = (means[best] - means[lod]).dropna()
    points = [
        (2.0 ** float(str(size)), own.mean(), *t_interval(own), int(given[size]))
        for size, own in loss.groupby(level="size")
    ]
    return pd.DataFrame(points, columns=list(COLUMNS))


def coarse(sizes: pd.Series) -> pd.Series:
    """Return log2 sizes taken together by half octaves, each at its own mean."""
    part: NDArray[np.intp] = np.round(sizes.to_numpy(dtype=float) * 2).astype(np.intp)
    return sizes.groupby(part).transform("mean")
