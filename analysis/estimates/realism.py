"""Perceived realism of every LoD at every distance: the ordinal mixed model on a study's ratings.

Means of ratings are what readers expect and stand beside it; inference rests on this model, because
treating ratings as a metric scale gives false alarms, misses and inversions (Liddell and Kruschke
2018, J. Exp. Soc. Psychol. 79).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtr

from analysis.estimates.stimuli import Cell, Stimuli, stimuli_of
from analysis.models.draws import draw
from analysis.models.fitting import OrdinalFit, fit
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE, OrdinalModel
from analysis.models.priors import PRIORS
from analysis.models.quadrature import normal_grid

Floats = NDArray[np.float64]
ENOUGH_FOR_STYLE: Final = 30.0  # ratings per person from which scatter and style can be told
_STYLE_NODES: Final = 7


@dataclass(frozen=True)
class Realism:
    """The fitted model and draws from what it leaves open.

    ``draws`` (n_draws, n_parameters) come from Student's t about the fit with one degree of freedom
    less than there are people: with ten of them a normal law would promise too much.
    """

    stimuli: Stimuli
    fit: OrdinalFit
    draws: Floats

    @property
    def cells(self) -> tuple[Cell, ...]:
        """The cells (distance, LoD) that were rated, in order."""
        return self.stimuli.cells

    def latent(self) -> tuple[Floats, Floats]:
        """Return the cells' places on the latent scale (n_cells,) and draws (n_draws, n_cells).

        The first cell stands at 0; the unit is the scatter of one person's ratings. Each eye beside
        its like, between the sides, the directions and the groups.
        """
        return self._places(self.fit.parameters[None])[0], self._places(self.draws)

    def expected(self) -> tuple[Floats, Floats]:
        """Return the population's mean rating of each cell (n_cells,) and draws of it."""
        return self._ratings(self.fit.parameters[None])[0], self._ratings(self.draws)

    def _places(self, parameters: Floats) -> Floats:
        at = self.fit.model.slices["location"].start
        own = parameters[:, at : at + len(self.cells) - 1]
        return np.column_stack([np.zeros(len(parameters)), own])

    def categories(self) -> tuple[Floats, Floats]:
        """Return the population's share of each rating for each cell (n_cells, n_categories).

        Beside it draws of the shares (n_draws, n_cells, n_categories).
        """
        return self._shares(self.fit.parameters[None])[0], self._shares(self.draws)

    def _shares(self, parameters: Floats) -> Floats:
        above = self._above(parameters)
        sure, never = np.ones((*above.shape[:2], 1)), np.zeros((*above.shape[:2], 1))
        return np.asarray(-np.diff(np.concatenate([sure, above, never], axis=2), axis=2))

    def _ratings(self, parameters: Floats) -> Floats:
        return np.asarray(self.stimuli.scale[0] + self._above(parameters).sum(axis=2))

    def _above(self, parameters: Floats) -> Floats:
        """Return the shares above each threshold (n_draws, n_cells, n_categories - 1).

        Averages over people: leniency in closed form, scatter and style on a small grid.
        """
        model = self.fit.model
        effects = [effect for effect in (INCONSISTENCY, STYLE) if effect in model.effects]
        grid = normal_grid([_STYLE_NODES] * len(effects))
        nodes = dict(zip(effects, grid.nodes, strict=True))
        spread, tau = model.spreads(parameters), model.thresholds(parameters)
        middle = tau @ model.middle()
        places = self._places(parameters)
        total = np.zeros((*places.shape, tau.shape[1]))
        for q, weight in enumerate(np.exp(grid.log_weights)):
            noise = np.exp(2 * spread[:, 1] * _node(nodes, INCONSISTENCY, q))
            width = np.sqrt(noise + spread[:, 0] ** 2)
            stretch = np.exp(spread[:, 2] * _node(nodes, STYLE, q))
            for k in range(tau.shape[1]):
                cut = middle + stretch * (tau[:, k] - middle)
                total[:, :, k] += weight * ndtr((places - cut[:, None]) / width[:, None])
        return total

    def table(self) -> pd.DataFrame:
        """Return distance, lod, latent and rating with 95 % intervals, ratings and people."""
        latent, latent_draws = self.latent()
        rating, rating_draws = self.expected()
        own = self.stimuli.table
        per_person = self.stimuli.counts.table.sum(axis=2)
        rows = []
        for i, (distance, lod) in enumerate(self.cells):
            mine = ((own["distance"] == distance) & (own["lod"] == lod)).to_numpy()
            given = per_person[:, mine].sum(axis=1)
            low, high = np.quantile(latent_draws[:, i], (0.025, 0.975))
            least, most = np.quantile(rating_draws[:, i], (0.025, 0.975))
            row = {"distance": distance, "lod": lod, "people": int((given > 0).sum())}
            row |= {"ratings": int(given.sum()), "latent": latent[i], "latent_low": low}
            row |= {"latent_high": high, "rating": rating[i]}
            rows.append(row | {"rating_low": least, "rating_high": most})
        return pd.DataFrame(rows)


def realism_of(
    ratings: pd.DataFrame,
    rng: np.random.Generator,
    *,
    scale: tuple[int, int],
    experts: dict[str, bool] | None = None,
    weights: dict[str, float] | None = None,
    near: Realism | None = None,
) -> Realism:
    """Fit the model to a ratings table.

    ``weights`` let a participant count for less than one; ``near`` is a fit to nearly the same
    ratings, from which this one is found sooner. People's scatter and end-avoidance are
    modelled where they gave enough ratings each. Raises ValueError without any rating.
    """
    stimuli = stimuli_of(ratings, scale=scale, experts=experts)
    counts = stimuli.counts
    full = counts.total / counts.people >= ENOUGH_FOR_STYLE
    model = OrdinalModel(
        stimuli.predictor(with_contrast=stimuli.can_tell_contrast()),
        counts.categories,
        (LENIENCY, INCONSISTENCY, STYLE) if full else (LENIENCY,),
    )
    given = weights or {}
    often = np.array([given.get(who, 1.0) for who in stimuli.people])
    found = fit(
        model,
        counts,
        priors=PRIORS,
        weights=often if weights else None,
        near=near.fit if near else None,
    )
    return Realism(stimuli, found, draw(found, rng, people=counts.people))


def _node(nodes: dict[str, Floats], effect: str, place: int) -> float:
    return float(nodes[effect][place]) if effect in nodes else 0.0
