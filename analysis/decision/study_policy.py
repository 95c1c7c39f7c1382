"""The policy of a whole study: from its tables, curves and verdicts to ``lod_policy.json``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from analysis.costs.cost import Costs
from analysis.curves.along_sizes import Curves
from analysis.curves.sizes import best_lod
from analysis.decision.effects import levels_of
from analysis.decision.margins import Margins
from analysis.decision.policy import Policy, policy_of, with_curves
from analysis.decision.verdicts import EQUIVALENT, Decision
from analysis.descriptive.means import answered
from analysis.tables.ordering import lod_ranks
from analysis.tables.reading import Tables
from analysis.words.versions import own_version


def policy_for(
    tables: Tables,
    curves: Curves,
    *,
    decisions: Sequence[Decision],
    margins: Margins,
    costs: Costs | None,
) -> Policy | None:
    """Derive a study's policy; None where no LoD below the best was shown at a known size."""
    ranks = margins.order(lod_ranks(tables.ratings))
    best = best_lod(tables.ratings, tables.comparisons, ranks)
    verdicts = _by_size(decisions, tables)
    ranked = {lod for lod in {*verdicts, *with_curves(curves)} if ranks.get(lod, -1.0) >= 0}
    if best is None or not ranked:
        return None
    return policy_of(
        curves,
        best,
        ranks,
        levels=levels_of(tables.ratings),
        margins=margins,
        costs=costs,
        provenance=_origin(tables, costs),
        verdicts=verdicts,
    )


def _by_size(decisions: Sequence[Decision], tables: Tables) -> dict[str, dict[float, bool]]:
    """Return whether each LoD was found equivalent, by the smallest size at the distance."""
    shown = tables.ratings[~tables.ratings["is_practice"]]
    size = shown.groupby("distance")["iris_px"].min().to_dict()
    found: dict[str, dict[float, bool]] = {}
    for decision in decisions:
        px = float(size.get(decision.distance, np.nan))
        for verdict in decision.verdicts if np.isfinite(px) else ():
            found.setdefault(verdict.lod, {})[px] = verdict.outcome == EQUIVALENT
    return found


def _origin(tables: Tables, costs: Costs | None) -> dict[str, Any]:
    named = tables.ratings[["study", "study_version"]].dropna(how="all").drop_duplicates()
    return {
        "command": "ocularist analyse",
        "version": own_version(),
        "study": [" ".join(map(str, row.dropna())) for _, row in named.iterrows()],
        "simulated": tables.is_simulated,
        "people": int(answered(tables.ratings)["participant"].nunique()),
        "ratings": len(answered(tables.ratings)),
        "comparisons": int((~tables.comparisons["is_practice"]).sum()),
        "costs": f"milliseconds of a frame per eye: {costs.condition}" if costs else None,
    }
