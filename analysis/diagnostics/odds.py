"""The proportional-odds check: are answers more scattered, or thresholds other, for some stimuli?

Likelihood-ratio tests like R's ``scale_test`` and ``nominal_test`` (package ordinal): the noise, or
the distances between thresholds, may differ between the levels of a factor. People's leniency is
in all fits; priors (LOOSE) only keep what the answers leave open from running away.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import chdtrc

from analysis.estimates.realism import Realism
from analysis.models.counts import Counts
from analysis.models.fitting import OrdinalFit, fit
from analysis.models.nesting import best_log_likelihood
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.models.priors import LOOSE

Floats = NDArray[np.float64]
SCALE, CATEGORIES = "scale", "categories"
COLUMNS: Final = ("factor", "test", "statistic", "dof", "p", "note")


def odds_tests(
    model: OrdinalModel,
    counts: Counts,
    factors: Mapping[str, Floats],
    *,
    weights: Floats | None = None,
) -> pd.DataFrame:
    """Test each factor's scale and category-specific effects; columns are COLUMNS.

    ``factors`` have for every level but the first a column of 0 and 1 (n_stimuli, n_levels - 1),
    which is also among the model's locations. ``statistic`` is twice the ratio's logarithm; ``p``
    takes it as chi-squared after the share of answers that the locations leave over. A test that
    the answers do not allow is empty and its ``note`` says why.
    """
    count = int((counts.table.sum(axis=(0, 1)) > 0).sum())
    if count < 3:
        note = f"people used {count} of the scale's categories; it takes three"
        return _empty(factors, note)
    used, own = _used(model, counts)
    plain = fit(used, own, priors=LOOSE, weights=weights)
    rows = []
    for factor, columns in factors.items():
        for test in (SCALE, CATEGORIES):
            rows.append({"factor": factor, "test": test, **_ratio(plain, columns, test)})
    return pd.DataFrame(rows, columns=list(COLUMNS))


def odds_of(realism: Realism) -> pd.DataFrame:
    """Test LoD and distance in a study's ratings, with people's leniency and the report's weights.

    People differ in leniency alone here: those who differ in scatter or in how they use the ends
    of the scale may show as scatter of a LoD.
    """
    own = realism.fit
    model = OrdinalModel(own.model.predictor, own.model.categories, (LENIENCY,))
    table = realism.stimuli.table
    factors = {
        name: _levels(table[column], [cell[place] for cell in realism.cells])
        for name, column, place in (("LoD", "lod", 1), ("distance", "distance", 0))
    }
    return odds_tests(model, own.counts, factors, weights=own.weights)


def _levels(values: pd.Series, order: list[str]) -> Floats:
    """Return a column (n_stimuli,) of 0 and 1 for every level but the first."""
    levels = list(dict.fromkeys(order))[1:]
    columns = [values.eq(level).to_numpy(dtype=float) for level in levels]
    return np.column_stack(columns) if columns else np.zeros((len(values), 0))


def _used(model: OrdinalModel, counts: Counts) -> tuple[OrdinalModel, Counts]:
    """Leave out the categories that nobody used: without priors they have no place."""
    is_used = counts.table.sum(axis=(0, 1)) > 0
    own = Counts(counts.table[:, :, is_used])
    return replace(model, categories=own.categories), own


def _ratio(plain: OrdinalFit, columns: Floats, test: str) -> dict[str, object]:
    if not columns.shape[1]:
        return _nothing("all stimuli share one level")
    terms = tuple(f"level_{i}" for i in range(2, columns.shape[1] + 2))
    wider = (
        replace(plain.model, scale=columns, scale_terms=terms)
        if test == SCALE
        else replace(plain.model, nominal=columns, nominal_terms=terms)
    )
    statistic = 2.0 * (best_log_likelihood(wider, plain) - plain.log_likelihood)
    statistic, dof = max(statistic, 0.0), len(wider.names) - len(plain.model.names)
    # Locations fitted to the same answers leave them less scattered than they are: with 140
    # answers and 16 parameters the plain ratio's mean is 1.15 times what chi-squared expects.
    left = 1.0 - len(plain.parameters) / max(plain.counts.total, len(plain.parameters))
    p = float(chdtrc(dof, statistic * left))
    return {"statistic": statistic, "dof": dof, "p": p, "note": ""}


def _nothing(note: str) -> dict[str, object]:
    return {"statistic": np.nan, "dof": 0, "p": np.nan, "note": note}


def _empty(factors: Mapping[str, Floats], note: str) -> pd.DataFrame:
    rows = [
        {"factor": factor, "test": test, **_nothing(note)}
        for factor in factors
        for test in (SCALE, CATEGORIES)
    ]
    return pd.DataFrame(rows, columns=list(COLUMNS))
