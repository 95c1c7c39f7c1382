"""Models beside the report's own: people all alike or who differ, another link, a metric scale.

By AIC on maximum likelihood, without priors; and by how well each foretells the ratings of a person
left out, with them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.diagnostics.left_out import FEWEST, MOST_REFITS, is_refitted, left_out
from analysis.diagnostics.metric_rival import MetricRival
from analysis.estimates.realism import Realism
from analysis.models.fitting import OrdinalFit, Problem, fit
from analysis.models.grids import thinned
from analysis.models.links import LOGIT
from analysis.models.optimum import climb
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE, OrdinalModel
from analysis.models.priors import LOOSE, PRIORS
from analysis.models.quadrature import normal_grid

Floats = NDArray[np.float64]
ALIKE, A0, A, METRIC = "people alike", "leniency", "leniency, scatter and style", "metric scale"
LOGISTIC = "leniency, logit link"
_EFFECTS: Final[dict[str, tuple[str, ...]]] = {
    ALIKE: (),
    A0: (LENIENCY,),
    A: (LENIENCY, INCONSISTENCY, STYLE),
}
COLUMNS: Final = (
    *("model", "parameters", "log_likelihood", "aic", "aic_difference"),
    *("left_out", "left_out_difference", "left_out_error", "left_out_by", "is_reported", "note"),
)
REFITS, EXPANSION, GROUPS = "fits without each person", "expansion", "20 groups of people"
_MOST_TRIED: Final = 3_000  # ratings up to which scatter and style are tried though few each
_FEW_NODES: Final = (15, 5, 5)  # for few ratings each, which leave people wide open
_QUICK: Final = 2e8  # people x stimuli x categories x nodes up to which a step is worth its time


def rivals(realism: Realism) -> pd.DataFrame:
    """Compare the models on the ratings; columns are COLUMNS.

    ``left_out`` is the log probability of ratings of people left out, its difference that from the
    report's own model with a standard error over people; the logit link, whose latent unit the
    priors are not made for, is compared by AIC alone. A model that was not fitted is empty and
    its ``note`` says why. Weights are the report's.
    """
    fits = {name: _fitted(realism, effects) for name, effects in _EFFECTS.items()}
    fits[LOGISTIC] = _logistic(fits[A0])
    often = _often(realism)
    metric = MetricRival(realism.fit.model.predictor, realism.fit.counts, often)
    logs = _left_out(realism, fits, metric)
    own = next(name for name, found in fits.items() if found is realism.fit)
    rows: list[dict[str, Any]] = []
    for name, found in fits.items():
        row: dict[str, Any] = {"model": name, "is_reported": name == own, "note": ""}
        if found is None:
            row["note"] = "people gave too few ratings each, and there are too many to try it"
        else:
            row |= {"parameters": _count(found), "log_likelihood": _best(found)}
        rows.append(row)
    row = {"model": METRIC, "is_reported": False, "note": "", "parameters": metric.parameters}
    rows.append(row | {"log_likelihood": metric.log_likelihood})
    told = [_differences(logs.get(row["model"]), logs.get(own), often) for row in rows]
    table = pd.DataFrame([row | more for row, more in zip(rows, told, strict=True)])
    table["aic"] = 2.0 * table["parameters"] - 2.0 * table["log_likelihood"]
    table["aic_difference"] = table["aic"] - table["aic"].min()
    table["left_out_by"] = [_how(fits.get(name), name, realism) for name in table["model"]]
    table.loc[table["left_out"].isna(), "left_out_by"] = ""
    return table.reindex(columns=list(COLUMNS)).astype({"parameters": "Int64"})


def _fitted(realism: Realism, effects: tuple[str, ...]) -> OrdinalFit | None:
    """Fit the report's model with other person effects; None where it would take too long."""
    own = realism.fit
    if effects == own.model.effects:
        return own
    model = OrdinalModel(own.model.predictor, own.model.categories, effects)
    if len(effects) < 2:
        return fit(model, own.counts, priors=PRIORS, weights=own.weights)
    if own.counts.total > _MOST_TRIED:
        return None
    start = [own.value(name) if name in own.model.names else np.log(0.2) for name in model.names]
    problem = Problem(model, own.counts, PRIORS, own.weights)
    whole = normal_grid(_FEW_NODES, reach=(5.5, 3.5, 3.5))
    grid = thinned(model, np.array(start), own.counts, whole)
    inverse = np.diag([0.25] * len(start))
    known = [i for i, name in enumerate(model.names) if name in own.model.names]
    inverse[np.ix_(known, known)] = own.covariance
    best = climb(problem.target(grid), np.array(start), inverse=inverse)[0]
    return problem.finish(grid, best, [])


def _logistic(probit: OrdinalFit | None) -> OrdinalFit | None:
    """Fit people's leniency with the logit link, from the probit's fit in the logit's unit."""
    if probit is None:
        return None
    model = replace(probit.model, link=LOGIT)
    start = probit.parameters.copy()
    for place, kind in enumerate(model.kinds):
        is_log = kind.startswith("log_")
        start[place] = start[place] + np.log(LOGIT.sd) if is_log else start[place] * LOGIT.sd
    start[[i for i, kind in enumerate(model.kinds) if kind == "contrast"]] /= LOGIT.sd
    return fit(model, probit.counts, priors=LOOSE, weights=probit.weights, start=start)


def _best(found: OrdinalFit) -> float:
    """Return the greatest log-likelihood, without priors, from a fit that has them."""
    counts = found.counts
    work = counts.people * counts.stimuli * counts.categories * found.grid.log_weights.size
    if work <= _QUICK and found.priors is not LOOSE:
        problem = Problem(found.model, counts, LOOSE, found.weights)
        target = problem.target(found.grid)
        best = climb(target, found.parameters, inverse=found.covariance)[0]
        return problem.value(best, found.grid)[0]
    # Priors so wide, or so many answers, that they hardly matter: to second order of what they do.
    priors = found.priors or LOOSE
    means, sds = np.array([priors[kind] for kind in found.model.kinds]).T
    pull = (found.parameters - means) / sds**2
    return float(found.log_likelihood + 0.5 * pull @ found.covariance @ pull)


def _count(found: OrdinalFit) -> int:
    """Count parameters; a category that nobody used has no threshold of its own."""
    used = int((found.counts.table.sum(axis=(0, 1)) > 0).sum())
    return len(found.parameters) - (found.counts.categories - used)


def _often(realism: Realism) -> Floats:
    weights = realism.fit.weights
    return np.ones(realism.fit.counts.people) if weights is None else weights


def _left_out(
    realism: Realism, fits: dict[str, OrdinalFit | None], metric: MetricRival
) -> dict[str, Floats]:
    if realism.fit.counts.people < FEWEST:
        return {}
    own = {name: found for name, found in fits.items() if name != LOGISTIC}
    found = {name: left_out(fitted) for name, fitted in own.items() if fitted is not None}
    return found | {METRIC: metric.left_out()}


def _differences(logs: Floats | None, own: Floats | None, often: Floats) -> dict[str, float]:
    """Return the sum over people and its difference from the report's, with its error."""
    names = ("left_out", "left_out_difference", "left_out_error")
    if logs is None or own is None:
        return dict.fromkeys(names, float("nan"))
    away = often * (logs - own)
    values = (often @ logs, away.sum(), np.sqrt(len(away)) * away.std(ddof=1))
    return {name: float(value) for name, value in zip(names, values, strict=True)}


def _how(found: OrdinalFit | None, name: str, realism: Realism) -> str:
    if name == METRIC:
        return REFITS if realism.fit.counts.people <= MOST_REFITS else GROUPS
    return REFITS if found is not None and is_refitted(found) else EXPANSION
