"""The numbers of perceived against actual LoD by the model: places, slopes, shares of ratings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import pandas as pd

from analysis.charts.material import Material
from analysis.descriptive.means import rating_counts
from analysis.estimates.realism import Realism
from analysis.tables.ordering import lod_ranks
from analysis.tables.records import records

_CENTRAL: Final = (0.025, 0.975)


def by_model_table(material: Material) -> pd.DataFrame:
    """Return the latent place and the share of each rating per ranked LoD and distance.

    Columns: distance, lod, lod_rank, latent with interval, slope with interval (latent per level of
    the LoD, least squares over the distance's LoDs), rating, predicted with interval (its share by
    the model, the population's mean), share (what was given), ratings (of how many).
    """
    realism = material.inference.realism
    ranks = lod_ranks(material.tables.ratings)
    if realism is None:
        return pd.DataFrame(columns=["distance", "lod"])
    kept = _ranked(realism, ranks)
    if not kept:
        return pd.DataFrame(columns=["distance", "lod"])
    low = material.tables.scale[0]
    given = rating_counts(material.tables.ratings, ["distance", "lod"], scale=material.tables.scale)
    counted = {(row["distance"], row["lod"]): row for row in records(given)}
    (latent, places), (shares, drawn) = realism.latent(), realism.categories()
    ends = np.quantile(places, _CENTRAL, axis=0), np.quantile(drawn, _CENTRAL, axis=0)
    slopes = _slopes(realism, kept, ranks)
    rows = []
    for i in kept:
        distance, lod = realism.cells[i]
        row: dict[str, object] = {"distance": distance, "lod": lod, "lod_rank": ranks[lod]}
        row |= {"latent": latent[i], "latent_low": ends[0][0, i], "latent_high": ends[0][1, i]}
        row |= dict(zip(("slope", "slope_low", "slope_high"), slopes[distance], strict=True))
        own = counted[distance, lod]
        for k in range(shares.shape[1]):
            told = {"rating": low + k, "predicted": shares[i, k], "predicted_low": ends[1][0, i, k]}
            told |= {"predicted_high": ends[1][1, i, k], "share": own[str(low + k)] / own["total"]}
            rows.append(row | told | {"ratings": own["total"]})
    return pd.DataFrame(rows)


def _ranked(realism: Realism, ranks: Mapping[str, float]) -> list[int]:
    """Return the cells with a ranked LoD, at distances where two or more were rated."""
    own = [i for i, (_, lod) in enumerate(realism.cells) if ranks.get(lod, -1.0) >= 0]
    at = [realism.cells[i][0] for i in own]
    return [i for i in own if at.count(realism.cells[i][0]) > 1]


def _slopes(
    realism: Realism, kept: Sequence[int], ranks: Mapping[str, float]
) -> dict[str, tuple[float, float, float]]:
    value, draws = realism.latent()
    found = {}
    for distance in dict.fromkeys(realism.cells[i][0] for i in kept):
        own = [i for i in kept if realism.cells[i][0] == distance]
        x = np.array([ranks[realism.cells[i][1]] for i in own])
        weights = (x - x.mean()) / ((x - x.mean()) ** 2).sum()
        low, high = np.quantile(draws[:, own] @ weights, _CENTRAL)
        found[distance] = (float(value[own] @ weights), float(low), float(high))
    return found
