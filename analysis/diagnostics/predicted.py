"""How often the ends of the scale are used, beside what the model would expect: fives and ones.

Posterior-predictive: parameters are drawn from what the fit leaves open, people from what their
answers leave open, then every rating anew. A model without end-avoidance expects too many fives of
people who never give one.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.diagnostics.answers import Answers, answers_of, probabilities
from analysis.estimates.realism import Realism

Floats = NDArray[np.float64]
Integers = NDArray[np.intp]
LOWEST, HIGHEST = "lowest", "highest"
COLUMNS: Final = (
    *("of", "distance", "lod", "participant", "end", "rating", "ratings"),
    *("count", "share", "predicted", "low", "high", "is_within"),
)
_REPLICATES: Final = (100, 400)  # fewest and most studies that are drawn
_ANSWERS: Final = 4_000_000  # answers drawn in all, beyond the fewest replicates
_MOST_DRAWS: Final = 40  # of the parameters
_PEOPLE_DRAWN: Final = 10  # times for one set of parameters
_PROBABILITIES: Final = 20_000_000  # evaluated in all: beyond, the estimate stands for its draws


@dataclass(frozen=True)
class Predicted:
    """Counts of one end of the scale in one grouping of the ratings (cells or people).

    ``counted`` (n_groups,) is what was given, ``drawn`` (n_replicates, n_groups) what the model
    gives, ``ratings`` (n_groups,) of how many.
    """

    of: str
    end: str
    ratings: Floats
    counted: Floats
    drawn: Floats

    def p_value(self) -> float:
        """Return how often the model strays from its own mean as far as the ratings do.

        All groups together: the sum of squared distances in units of their variance. Small where
        the groups differ otherwise than the model expects.
        """
        mean, spread = self.drawn.mean(axis=0), self.drawn.var(axis=0)
        kept = spread > 0
        if not kept.any():
            return 1.0
        away = ((self.drawn - mean) ** 2)[:, kept] @ (1 / spread[kept])
        own = float((((self.counted - mean) ** 2)[kept] / spread[kept]).sum())
        return float((1 + (away >= own - 1e-9).sum()) / (1 + len(away)))


def predicted_ends(realism: Realism, rng: np.random.Generator) -> tuple[Predicted, ...]:
    """Return the lowest and the highest rating by cell, then by person, as the model draws them."""
    answers = answers_of(realism.fit.counts)
    groups = {"cell": _cell_of(realism)[answers.stimulus], "person": answers.person}
    sizes = {"cell": len(realism.cells), "person": len(realism.stimuli.people)}
    last = realism.fit.counts.categories - 1
    drawn: dict[tuple[str, str], list[Floats]] = {
        (of, end): [] for of in groups for end in (LOWEST, HIGHEST)
    }
    for share in _shares(realism, answers, rng):
        level = rng.random(len(share))
        given = {LOWEST: level < share[:, 0], HIGHEST: level > 1.0 - share[:, last]}
        for (of, end), rows in drawn.items():
            rows.append(np.bincount(groups[of][given[end]], minlength=sizes[of]).astype(float))
    told = {LOWEST: answers.category == 0, HIGHEST: answers.category == last}
    return tuple(
        Predicted(
            of=of,
            end=end,
            ratings=np.bincount(groups[of], minlength=sizes[of]).astype(float),
            counted=np.bincount(groups[of][told[end]], minlength=sizes[of]).astype(float),
            drawn=np.array(rows),
        )
        for (of, end), rows in drawn.items()
    )


def predicted_shares(
    realism: Realism, rng: np.random.Generator, *, ends: tuple[Predicted, ...] | None = None
) -> pd.DataFrame:
    """Return the share of lowest and of highest ratings beside the model's; columns are COLUMNS.

    A row for every cell and every person (``of``): what was given, what the model expects
    (``predicted``) and in which 95 % of drawn studies it lies (``low`` to ``high``). ``ends`` are
    ``predicted_ends`` where they are known.
    """
    found = predicted_ends(realism, rng) if ends is None else ends
    return pd.concat([_table(realism, own) for own in found], ignore_index=True)


def _table(realism: Realism, own: Predicted) -> pd.DataFrame:
    low, high = np.quantile(own.drawn, (0.025, 0.975), axis=0, method="inverted_cdf")
    is_cell = own.of == "cell"
    count = len(own.counted)
    cells = realism.cells if is_cell else [(None, None)] * count
    who = [None] * count if is_cell else list(realism.stimuli.people)
    table = pd.DataFrame(
        {
            "of": own.of,
            "distance": [distance for distance, _ in cells],
            "lod": [lod for _, lod in cells],
            "participant": who,
            "end": own.end,
            "rating": realism.stimuli.scale[int(own.end == HIGHEST)],
            "ratings": own.ratings.astype(int),
            "count": own.counted.astype(int),
            "share": own.counted / own.ratings,
            "predicted": own.drawn.mean(axis=0) / own.ratings,
            "low": low / own.ratings,
            "high": high / own.ratings,
            "is_within": (low <= own.counted) & (own.counted <= high),
        }
    )
    return table[list(COLUMNS)]


def _shares(realism: Realism, answers: Answers, rng: np.random.Generator) -> Iterator[Floats]:
    """Yield each answer's probabilities (n_answers, n_categories), once for each replicate."""
    fit, size = realism.fit, max(len(answers.person), 1)
    least, most = _REPLICATES
    replicates = int(np.clip(_ANSWERS // size, least, most))
    draws = _PROBABILITIES // (fit.counts.stimuli * fit.counts.categories * fit.grid.nodes.shape[1])
    draws = int(np.clip(draws, 1, _MOST_DRAWS))
    each = -(-replicates // draws)
    times = min(each, _PEOPLE_DRAWN)
    for number in range(draws):
        # One set of parameters: with so many answers the estimate's own error is out of sight.
        own = fit.parameters if draws == 1 else realism.draws[number]
        for share in probabilities(
            fit.model, own, fit.counts, fit.grid, answers=answers, rng=rng, times=times
        ):
            yield from itertools.repeat(share, -(-each // times))


def _cell_of(realism: Realism) -> Integers:
    """Return the number of each stimulus's cell (n_stimuli,)."""
    place = {cell: i for i, cell in enumerate(realism.cells)}
    table = realism.stimuli.table
    pairs = zip(table["distance"], table["lod"], strict=True)
    return np.array([place[pair] for pair in pairs], dtype=np.intp)
