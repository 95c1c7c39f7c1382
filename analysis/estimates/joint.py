"""One scale of realism from ratings and comparisons together.

Ratings place every eye on a latent scale; of a pair's two eyes the comparison says D = a (right -
left) on the same scale, a the comparisons' units in one of the ratings'. Comparisons stay within a
distance, so distances are linked by the ratings alone, and by people only where the same people
rated at several distances (``linkage`` says which). Noticing does not belong on this scale: what is
seen to differ need not look less real.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtr

from analysis.estimates.preference import JOD
from analysis.estimates.realism import Realism
from analysis.estimates.stimuli import Cell
from analysis.models.composite import Composite, CompositeFit, Part, fit_composite, sandwich
from analysis.models.counts import count_answers
from analysis.models.draws import draw_about
from analysis.models.fitting import OrdinalFit, fit
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.models.predictors import Linear
from analysis.models.priors import PRIORS

Floats = NDArray[np.float64]
_CENTRAL: Final = (0.025, 0.975)


@dataclass(frozen=True)
class Joint:
    """The fitted joint scale and draws from what it leaves open.

    ``draws`` (n_draws, n_parameters) rest on the sandwich covariance; ``alone`` are the same
    ratings without the comparisons. ``compared`` is how many comparisons took part.
    """

    cells: tuple[Cell, ...]
    lowest: int
    fit: CompositeFit
    draws: Floats
    alone: OrdinalFit
    alone_draws: Floats
    compared: int

    def latent(self) -> tuple[Floats, Floats]:
        """Return the cells' places (n_cells,), the first at 0, and draws (n_draws, n_cells)."""
        return self._places(self.fit.parameters[None])[0], self._places(self.draws)

    def latent_alone(self) -> tuple[Floats, Floats]:
        """Return the places and draws of them by the ratings alone, as ``latent`` does."""
        return self._places(self.alone.parameters[None])[0], self._places(self.alone_draws)

    def _places(self, parameters: Floats) -> Floats:
        at = self.alone.model.slices["location"].start
        own = parameters[:, at : at + len(self.cells) - 1]
        return np.column_stack([np.zeros(len(parameters)), own])

    def expected(self) -> tuple[Floats, Floats]:
        """Return the population's mean rating of each cell (n_cells,) and draws of it."""
        return self._ratings(self.fit.parameters[None])[0], self._ratings(self.draws)

    def _ratings(self, parameters: Floats) -> Floats:
        model = self.alone.model
        first = parameters[:, : len(model.names)]
        tau, width = model.thresholds(first), np.hypot(1.0, model.spreads(first)[:, 0])
        bounds = (self._places(parameters)[:, :, None] - tau[:, None]) / width[:, None, None]
        return np.asarray(self.lowest + ndtr(bounds).sum(axis=2))

    def jod_per_unit(self) -> tuple[float, Floats]:
        """Return how many JOD one unit of the latent scale is, and draws of it."""
        at = len(self.alone.model.names)
        return JOD * float(np.exp(self.fit.parameters[at])), JOD * np.exp(self.draws[:, at])

    def table(self, best: Mapping[str, str]) -> pd.DataFrame:
        """Return distance, lod, latent place and mean rating, and the loss to the best in points.

        ``best`` names each distance's best LoD. ``loss_alone_low`` and ``_high`` are the loss by
        the ratings alone: ``width_ratio`` below 1 says what the comparisons add.
        """
        (latent, places), (rating, ratings) = self.latent(), self.expected()
        alone = self._ratings(self.alone_draws)
        rows = []
        for i, (distance, lod) in enumerate(self.cells):
            row: dict[str, object] = {"distance": distance, "lod": lod, "latent": latent[i]}
            row |= _bounds("latent", places[:, i]) | {"rating": rating[i]}
            row |= _bounds("rating", ratings[:, i])
            top = (distance, best.get(distance, ""))
            if top in self.cells and top[1] != lod:
                k = self.cells.index(top)
                joint, single = ratings[:, k] - ratings[:, i], alone[:, k] - alone[:, i]
                own, other = _bounds("loss", joint), _bounds("loss_alone", single)
                width = np.diff(list(own.values()))[0] / np.diff(list(other.values()))[0]
                row |= {"loss": rating[k] - rating[i], **own, **other, "width_ratio": width}
            rows.append(row)
        return pd.DataFrame(rows)


def joint_of(
    realism: Realism,
    comparisons: pd.DataFrame,
    rng: np.random.Generator,
    *,
    weights: Mapping[str, float] | None = None,
) -> Joint | None:
    """Fit ratings and comparisons together; None where no compared pair was rated.

    People's leniency alone is modelled: what a person's scatter adds, the sandwich takes in.
    ``weights`` let a participant count for less than one.
    """
    stimuli, cells = realism.stimuli, realism.cells
    rows = _compared(comparisons, cells)
    if rows.empty:
        return None
    people = list(dict.fromkeys([*stimuli.people, *rows["participant"].astype(str)]))
    number = {who: i for i, who in enumerate(people)}
    often = np.array([(weights or {}).get(who, 1.0) for who in people])
    own = np.array([number[who] for who in stimuli.people], dtype=np.intp)
    alone = _ratings_alone(realism, often[own])
    first = Part(alone.model, alone.counts, alone.grid, own, often[own])
    second = _second(rows, cells, number, often)
    model = Composite(first, second, len(cells) - 1, len(people))
    apart = fit(
        second.model, second.counts, priors=PRIORS, weights=second.weights, grid=second.grid
    )
    start = model.join(alone.parameters, apart.parameters, log_scale=0.0)
    found = fit_composite(model, start, priors=PRIORS)
    spread = {"people": len(people)}
    return Joint(
        cells=cells,
        lowest=stimuli.scale[0],
        fit=found,
        draws=draw_about(found.parameters, found.covariance, rng, **spread),
        alone=alone,
        alone_draws=draw_about(
            alone.parameters,
            sandwich(first.by_person, alone.parameters, alone.covariance),
            rng,
            **spread,
        ),
        compared=len(rows),
    )


def _ratings_alone(realism: Realism, often: Floats) -> OrdinalFit:
    """Return the ratings' fit with leniency alone, and equal weights left out."""
    if realism.fit.model.effects == (LENIENCY,):
        return realism.fit
    model = OrdinalModel(realism.fit.model.predictor, realism.fit.model.categories, (LENIENCY,))
    return fit(model, realism.stimuli.counts, priors=PRIORS, weights=often)


def _compared(comparisons: pd.DataFrame, cells: tuple[Cell, ...]) -> pd.DataFrame:
    """Return the comparisons that count, of two eyes that were both rated somewhere."""
    rows = comparisons[comparisons["comparison"].notna() & ~comparisons["is_practice"]]
    known = set(cells)
    pairs = zip(rows["distance"], rows["left_lod"], rows["right_lod"], strict=True)
    kept = [(where, left) in known and (where, right) in known for where, left, right in pairs]
    rows = rows[np.array(kept, dtype=bool)]
    return rows if (rows["left_lod"] != rows["right_lod"]).any() else rows.iloc[:0]


def _second(
    rows: pd.DataFrame, cells: tuple[Cell, ...], number: Mapping[str, int], often: Floats
) -> Part:
    """Return the comparisons' part: its terms are the cells but the first, as the ratings' are."""
    keys = ["distance", "left_lod", "right_lod"]
    place = rows.groupby(keys, sort=True, observed=True).ngroup().to_numpy()
    pairs = rows.assign(pair=place).drop_duplicates("pair").sort_values("pair")[keys]
    at = {cell: i for i, cell in enumerate(cells)}
    design = np.zeros((len(pairs), len(cells)))
    for row, (distance, left, right) in enumerate(pairs.itertuples(index=False, name=None)):
        design[row, at[distance, right]] += 1.0
        design[row, at[distance, left]] -= 1.0
    who, people = pd.factorize(rows["participant"].astype(str))
    answer = rows["comparison"].astype(int).to_numpy() + 1
    counts = count_answers(who, place, answer, shape=(len(people), len(pairs), 3))
    names = tuple(f"{distance}: {lod}" for distance, lod in cells[1:])
    model = OrdinalModel(Linear(design[:, 1:], names), 3, (LENIENCY,))
    own = np.array([number[who] for who in people], dtype=np.intp)
    grid = fit(model, counts, priors=PRIORS, weights=often[own]).grid
    return Part(model, counts, grid, own, often[own])


def _bounds(name: str, draws: Floats) -> dict[str, float]:
    low, high = np.quantile(draws, _CENTRAL)
    return {f"{name}_low": float(low), f"{name}_high": float(high)}
