"""Which LoD is called more realistic: a Thurstone scale with "no difference" and a side effect.

    P(-1) = Phi(-delta - lambda - D),  P(0) = Phi(delta - lambda - D) - P(-1),  D = q_right - q_left

in units of the scatter of a difference; 1 JOD is 1.4826 of them, so that 1 JOD is 75 % preference
where nobody may say "no difference" (Perez-Ortiz and Mantiuk 2017). Ties are answers like others:
their share is the evidence that two LoDs look alike. A distance's scale starts at its highest LoD;
no comparison links two distances, so their scales cannot be compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtr

from analysis.models.counts import count_answers
from analysis.models.draws import draw
from analysis.models.fitting import OrdinalFit, fit
from analysis.models.ordinal import LENIENCY, STYLE, OrdinalModel
from analysis.models.predictors import Linear
from analysis.models.priors import PRIORS
from analysis.tables.ordering import distance_order, lod_ranks

Floats = NDArray[np.float64]
Cell = tuple[str, str]
JOD: Final = 1.4826  # standard deviations of a difference: Phi(1 / 1.4826) = 0.75
ENOUGH_PER_PERSON: Final = 12.0  # comparisons from which a person's side and band can be told


@dataclass(frozen=True)
class Preference:
    """The fitted scale and draws from what it leaves open.

    ``cells`` are the LoDs (distance, LoD) on the scale and ``references`` the cell that each is
    measured from: the highest LoD that comparisons link it to.
    """

    fit: OrdinalFit
    draws: Floats
    cells: tuple[Cell, ...]
    references: tuple[Cell, ...]
    free: tuple[Cell, ...]  # cells that are no reference, in the predictor's order
    people: int
    answers: int

    def jod(self) -> tuple[Floats, Floats]:
        """Return every cell's place in JOD (n_cells,), references at 0, and draws of it."""
        return self._jod(self.fit.parameters[None])[0], self._jod(self.draws)

    def _jod(self, parameters: Floats) -> Floats:
        at = self.fit.model.slices["location"].start
        places = {cell: at + i for i, cell in enumerate(self.free)}
        zero = np.zeros(len(parameters))
        return JOD * np.column_stack(
            [parameters[:, places[cell]] if cell in places else zero for cell in self.cells]
        )

    def side(self) -> tuple[float, Floats]:
        """Return what standing on the right adds, in JOD, and draws of it."""
        model = self.fit.model

        def added(parameters: Floats) -> Floats:
            return np.asarray(-JOD * model.thresholds(parameters).mean(axis=-1))

        return float(added(self.fit.parameters)), added(self.draws)

    def shares(self, better: Cell, worse: Cell) -> tuple[float, float, float]:
        """Return the shares (better preferred, no difference, worse preferred), sides averaged."""
        places = dict(zip(self.cells, self.jod()[0] / JOD, strict=True))
        away = places[better] - places[worse]
        half = float(np.diff(self.fit.model.thresholds(self.fit.parameters))[0]) / 2
        win, loss = float(ndtr(away - half)), float(ndtr(-away - half))
        return win, 1.0 - win - loss, loss

    def table(self) -> pd.DataFrame:
        """Return distance, lod, reference, jod and its 95 % interval."""
        place, draws = self.jod()
        low, high = np.quantile(draws, (0.025, 0.975), axis=0)
        rows = [
            {
                "distance": cell[0],
                "lod": cell[1],
                "reference": self.references[i][1],
                "jod": place[i],
                "jod_low": low[i] if cell in self.free else np.nan,
                "jod_high": high[i] if cell in self.free else np.nan,
            }
            for i, cell in enumerate(self.cells)
        ]
        return pd.DataFrame(rows)


def preference_of(
    comparisons: pd.DataFrame,
    ratings: pd.DataFrame,
    rng: np.random.Generator,
    *,
    weights: dict[str, float] | None = None,
) -> Preference | None:
    """Fit the scale to the comparisons that count; None where nobody compared different LoDs.

    ``ratings`` tell the order of distances and the LoDs' ranks; ``weights`` let a participant count
    for less than one.
    """
    rows = comparisons[comparisons["comparison"].notna() & ~comparisons["is_practice"]]
    if (rows["left_lod"] == rows["right_lod"]).all():
        return None
    keys = ["distance", "left_lod", "right_lod"]
    own = rows.groupby(keys, sort=True, observed=True).ngroup().to_numpy()
    pairs = rows.assign(stimulus=own).drop_duplicates("stimulus").sort_values("stimulus")[keys]
    ranks = lod_ranks(ratings)
    linked = _references(pairs, ranks)
    order = {name: i for i, name in enumerate(distance_order(pd.concat([ratings, rows])))}
    cells = sorted(linked, key=lambda cell: (order[cell[0]], ranks.get(cell[1], -1.0), cell[1]))
    free = [cell for cell in cells if linked[cell] != cell]
    who, people = pd.factorize(rows["participant"])
    answer = rows["comparison"].astype(int).to_numpy() + 1
    counts = count_answers(who, own, answer, shape=(len(people), len(pairs), 3))
    is_rich = counts.total / counts.people >= ENOUGH_PER_PERSON
    names = tuple(f"{distance}: {lod}" for distance, lod in free)
    model = OrdinalModel(
        Linear(_design(pairs, free), names), 3, (LENIENCY, STYLE) if is_rich else ()
    )
    often = np.array([(weights or {}).get(str(who), 1.0) for who in people])
    found = fit(model, counts, priors=PRIORS, weights=often if weights else None)
    return Preference(
        fit=found,
        draws=draw(found, rng, people=len(people)),
        cells=tuple(cells),
        references=tuple(linked[cell] for cell in cells),
        free=tuple(free),
        people=len(people),
        answers=len(rows),
    )


def _design(pairs: pd.DataFrame, free: list[Cell]) -> Floats:
    """Return +1 for the LoD on the right and -1 for that on the left (n_pairs, n_free)."""
    place = {cell: i for i, cell in enumerate(free)}
    design = np.zeros((len(pairs), len(free)))
    for row, (distance, left, right) in enumerate(pairs.itertuples(index=False, name=None)):
        for lod, sign in ((right, 1.0), (left, -1.0)):
            if (distance, lod) in place:
                design[row, place[distance, lod]] += sign
    return design


def _references(pairs: pd.DataFrame, ranks: dict[str, float]) -> dict[Cell, Cell]:
    """Return for each compared LoD the highest one that comparisons link it to."""
    group: dict[Cell, set[Cell]] = {}
    for distance, left, right in pairs.itertuples(index=False, name=None):
        one, other = (distance, left), (distance, right)
        joined = group.get(one, {one}) | group.get(other, {other})
        for cell in joined:
            group[cell] = joined
    return {
        cell: max(linked, key=lambda c: (ranks.get(c[1], -1.0), c[1]))
        for cell, linked in group.items()
    }
