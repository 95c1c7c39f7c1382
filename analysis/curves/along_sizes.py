"""All curves of a study, and in words what its sizes cannot say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.curves.curve import SizeCurve
from analysis.curves.noticed import noticed_curves
from analysis.curves.preferred import preferred_curves
from analysis.curves.rated import rated_curves
from analysis.curves.sizes import MEASURES, PIXELS, Measure, best_lod, with_size
from analysis.decision.margins import Margins
from analysis.tables.reading import Tables


@dataclass(frozen=True)
class Curves:
    """The curves that a study's sizes allow; ``notes`` say why there are no more."""

    curves: tuple[SizeCurve, ...] = ()
    notes: tuple[str, ...] = ()

    def of(self, kind: str, measure: Measure = PIXELS) -> dict[str, SizeCurve]:
        """Return the curves of one kind over one measure, by LoD."""
        return {c.lod: c for c in self.curves if c.kind == kind and c.measure == measure}


NO_CURVES: Final = Curves()


def curves_of(
    tables: Tables,
    rng: np.random.Generator,
    *,
    margins: Margins,
    ranks: Mapping[str, float],
    experts: Mapping[str, bool],
    weights: Mapping[str, float] | None = None,
) -> Curves:
    """Fit noticing, preference and loss of realism over pixels, and over degrees if known.

    ``ranks`` order the LoDs, the best highest; ``experts`` says who is one.
    """
    best = best_lod(tables.ratings, tables.comparisons, ranks)
    if best is None:
        return Curves(notes=("No LoD has a rank: none counts as the best to compare with.",))
    found: list[SizeCurve] = []
    notes: list[str] = []
    for measure in MEASURES:
        compared = tables.comparisons
        made = [
            *noticed_curves(compared, measure, rng, best=best, margins=margins, weights=weights),
            *preferred_curves(compared, measure, rng, best=best, margins=margins, weights=weights),
            *rated_curves(
                tables.ratings,
                measure,
                rng,
                best=best,
                scale=tables.scale,
                margins=margins,
                experts=experts,
                weights=weights,
            ),
        ]
        found += made
        notes += _notes(tables, measure, best, made)
    return Curves(tuple(found), tuple(notes))


def _notes(tables: Tables, measure: Measure, best: str, made: list[SizeCurve]) -> list[str]:
    sized = with_size(tables.ratings[~tables.ratings["is_practice"]], measure)
    if sized.empty:
        return [f"The size of the iris in {measure.name} ({measure.column}) is not known."]
    lods = {str(lod) for lod in sized["lod"].unique()} - {best}
    missing = sorted(lods - {curve.lod for curve in made})
    if not missing:
        return []
    return [
        f"No curve over {measure.name} for {', '.join(missing)}: it takes answers at "
        f"two sizes, and to {best} too."
    ]
