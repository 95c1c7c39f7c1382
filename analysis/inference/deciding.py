"""The quickest way from tables to verdicts: only the fits that decisions rest on."""

from __future__ import annotations

from typing import Final
from zlib import crc32

import numpy as np

from analysis.decision.margins import Margins
from analysis.decision.verdicts import Decision, decide
from analysis.descriptive.means import answered
from analysis.estimates.noticing import Noticing, noticing_of
from analysis.estimates.realism import Realism, realism_of
from analysis.tables.ordering import lod_ranks
from analysis.tables.reading import Tables

SEED: Final = 20120831  # of the draws; the same tables give the same report


def decisions_of(
    tables: Tables,
    *,
    margins: Margins | None = None,
    weights: dict[str, float] | None = None,
    near: tuple[Realism | None, Noticing | None] = (None, None),
) -> tuple[Decision, ...]:
    """Return the decisions of ``infer`` alone: fits nothing that they do not rest on.

    ``near`` are fits to nearly the same tables, from which these are found sooner.
    """
    margins = margins or tables.margins
    if count_people(tables) < 2:
        return ()
    realism = fit_realism(tables, weights, near=near[0])
    return decide_by(tables, realism, fit_noticing(tables, weights, near=near[1]), margins)


def count_people(tables: Tables) -> int:
    """Return how many people rated or compared."""
    return len({*tables.ratings["participant"], *tables.comparisons["participant"]})


def rng_of(model: str) -> np.random.Generator:
    """Return each model's own draws: they do not depend on which other models are fitted."""
    return np.random.default_rng([SEED, crc32(model.encode())])


def fit_realism(
    tables: Tables, weights: dict[str, float] | None, *, near: Realism | None = None
) -> Realism | None:
    """Fit the realism of every LoD at every distance; None without ratings."""
    if not len(answered(tables.ratings)):
        return None
    return realism_of(
        tables.ratings,
        rng_of("realism"),
        scale=tables.scale,
        experts=experts_of(tables),
        weights=weights,
        near=near,
    )


def fit_noticing(
    tables: Tables, weights: dict[str, float] | None, *, near: Noticing | None = None
) -> Noticing | None:
    """Fit who notices which pair; None without pairs of equal LoDs."""
    rng = rng_of("noticing")
    return noticing_of(tables.comparisons, tables.ratings, rng, weights=weights, near=near)


def decide_by(
    tables: Tables, realism: Realism | None, noticing: Noticing | None, margins: Margins
) -> tuple[Decision, ...]:
    """Decide on the LoDs with a rank at every distance."""
    if realism is None:
        return ()
    return tuple(decide(realism, noticing, lod_ranks(tables.ratings), margins=margins))


def experts_of(tables: Tables) -> dict[str, bool]:
    """Return who works with graphics, as far as they said."""
    people = tables.participants
    if people.empty or "works_with_graphics" not in people:
        return {}
    said = people.dropna(subset=["works_with_graphics"])
    return {
        str(who): str(answer) == "yes"
        for who, answer in zip(said["participant"], said["works_with_graphics"], strict=True)
    }
