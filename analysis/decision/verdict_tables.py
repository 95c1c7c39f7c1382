"""The verdicts as decision.csv and effects-decision.csv have them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd

from analysis.costs.cost import Costs
from analysis.costs.savings import lod_saving, saving_columns
from analysis.decision.effects import EffectVerdict, saving_of
from analysis.decision.verdicts import Decision, Test
from analysis.estimates.multiplicity import holm

COLUMNS: Final = (
    *("distance", "lod", "best", "change", "verdict"),
    *("realism_loss", "realism_loss_low", "realism_loss_high", "realism_margin"),
    *("noticed_excess", "noticed_excess_low", "noticed_excess_high", "noticed_margin"),
    *("p_equivalent", "p_different"),
)


def effect_table(verdicts: Sequence[EffectVerdict], costs: Costs | None = None) -> pd.DataFrame:
    """Return one row per LoD and distance, as effects-decision.csv has them."""
    rows = []
    for own in verdicts:
        unknown = Test(np.nan, np.nan, np.nan, np.nan)
        tests = (own.realism, own.noticed or unknown)
        numbers = [n for test in tests for n in (test.value, test.low, test.high, test.margin)]
        head = (own.distance, own.lod, own.best, own.name, own.outcome)
        row = dict(zip(COLUMNS, (*head, *numbers, own.p_equivalent, own.p_different), strict=True))
        rows.append({**row, **(saving_columns(saving_of(own, costs)) if costs else {})})
    return pd.DataFrame(rows)


def verdict_table(decisions: list[Decision], costs: Costs | None = None) -> pd.DataFrame:
    """Return one row per distance and LoD, as decision.csv has them; savings where costs are known.

    ``p_equivalent`` is the p value of "it is not enough" along the sequence down to the LoD, and
    ``p_equivalent_holm`` the same adjusted over the distances at which the LoD was judged.
    """
    rows = []
    for decision in decisions:
        p_value = 0.0
        for verdict in decision.verdicts:
            noticed = verdict.noticed
            p_value = max(p_value, verdict.realism.p_beyond, noticed.p_beyond if noticed else 1.0)
            row: dict[str, object] = {
                "distance": decision.distance,
                "lod": verdict.lod,
                "best": verdict.best,
                "verdict": verdict.outcome,
                "is_tested": verdict.is_reached,
                "realism_loss": verdict.realism.value,
                "realism_loss_low": verdict.realism.low,
                "realism_loss_high": verdict.realism.high,
                "realism_margin": verdict.realism.margin,
                "noticed_excess": noticed.value if noticed else np.nan,
                "noticed_excess_low": noticed.low if noticed else np.nan,
                "noticed_excess_high": noticed.high if noticed else np.nan,
                "noticed_margin": noticed.margin if noticed else np.nan,
                "share_cheapest": verdict.share_cheapest,
                "chosen": decision.lod == verdict.lod,
                "p_equivalent": p_value,
            }
            if costs:
                saving = lod_saving(costs, decision.distance, verdict.lod, best=verdict.best)
                row |= saving_columns(saving)
            rows.append(row)
    table = pd.DataFrame(rows)
    if rows:
        table["p_equivalent_holm"] = table.groupby("lod")["p_equivalent"].transform(holm)
    return table
