"""All models of one study's tables, fitted once: what the report's verdicts rest on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final
from zlib import crc32

import numpy as np
import pandas as pd

from analysis.cost import Costs
from analysis.curves.along_sizes import NO_CURVES, Curves, curves_of
from analysis.curves.curve import curve_table, point_table, threshold_table
from analysis.decision.effects import EffectVerdict, decide_effects, effect_table, levels_of
from analysis.decision.margins import Margins
from analysis.decision.pareto import ParetoPoint, pareto, pareto_table
from analysis.decision.policy import Policy, policy_for
from analysis.decision.verdicts import Decision, decide, verdict_table
from analysis.descriptive import answered
from analysis.estimates.noticing import Noticing, noticing_of
from analysis.estimates.preference import Preference, preference_of
from analysis.estimates.realism import Realism, realism_of
from analysis.ordering import lod_ranks
from analysis.reading import Tables

SEED: Final = 20120831  # of the draws; the same tables give the same report


@dataclass(frozen=True)
class Inference:
    """The fitted models and the decisions; None where the tables say nothing of a model.

    ``decisions`` are the verdicts on LoDs with a rank, ``effects`` those on LoDs without one;
    ``curves`` run along the iris's size and ``policy`` follows from them; ``pareto`` sets realism
    against cost, empty without a benchmark.
    """

    realism: Realism | None
    preference: Preference | None
    noticing: Noticing | None
    decisions: tuple[Decision, ...]
    margins: Margins
    effects: tuple[EffectVerdict, ...] = ()
    curves: Curves = NO_CURVES
    policy: Policy | None = None
    pareto: tuple[ParetoPoint, ...] = ()
    costs: Costs | None = None

    def tables(self) -> dict[str, pd.DataFrame]:
        """Return the numbers by file name; models that could not be fitted are left out."""
        made: dict[str, pd.DataFrame] = {}
        own: dict[str, Any] = {"confidence": self.margins.confidence}
        own["margins"] = self.margins.origins
        if self.decisions:
            made["decision"] = verdict_table(list(self.decisions), self.costs).assign(**own)
        if self.effects:
            made["effects-decision"] = effect_table(self.effects, self.costs).assign(**own)
        if self.curves.curves:
            made["curves"] = curve_table(self.curves.curves)
            made["curve-points"] = point_table(self.curves.curves)
            made["thresholds"] = threshold_table(self.curves.curves)
        if self.pareto:
            made["pareto"] = pareto_table(self.pareto)
        for name, model in (
            ("realism-model", self.realism),
            ("preference-model", self.preference),
            ("noticing-model", self.noticing),
        ):
            if model is not None:
                made[name] = model.table()
        return made

    def warnings(self) -> list[str]:
        """Return what the fits warn of, by model."""
        fits = [("realism", self.realism), ("preference", self.preference)]
        return [
            f"The model of {name}: {warning}."
            for name, model in [*fits, ("noticing", self.noticing)]
            if model is not None
            for warning in model.fit.warnings
        ]


def infer(
    tables: Tables,
    *,
    margins: Margins | None = None,
    weights: dict[str, float] | None = None,
    costs: Costs | None = None,
) -> Inference:
    """Fit every model that the tables allow and decide by the margins.

    Without ``margins`` by those that the study declared. ``weights`` let a participant's answers
    count for less than one; ``costs`` are what LoDs cost where that was measured.
    """
    margins = margins or tables.margins
    if _people(tables) < 2:  # one person says nothing about others
        return Inference(None, None, None, (), margins, costs=costs)
    realism, noticing = _realism(tables, weights), _noticing(tables, weights)
    ranks, levels = lod_ranks(tables.ratings), levels_of(tables.ratings)
    curves = curves_of(
        tables,
        _rng("curves"),
        margins=margins,
        ranks=margins.order(ranks),
        experts=_experts(tables),
        weights=weights,
    )
    decisions = _decisions(tables, realism, noticing, margins)
    return Inference(
        realism=realism,
        preference=preference_of(
            tables.comparisons, tables.ratings, _rng("preference"), weights=weights
        ),
        noticing=noticing,
        decisions=decisions,
        margins=margins,
        effects=tuple(
            decide_effects(realism, noticing, ranks, levels=levels, margins=margins)
            if realism
            else ()
        ),
        curves=curves,
        policy=policy_for(tables, curves, decisions=decisions, margins=margins, costs=costs),
        pareto=pareto(realism, costs) if realism and costs else (),
        costs=costs,
    )


def decisions_of(
    tables: Tables, *, margins: Margins | None = None, weights: dict[str, float] | None = None
) -> tuple[Decision, ...]:
    """Return the decisions of ``infer`` alone: fits nothing that they do not rest on."""
    margins = margins or tables.margins
    if _people(tables) < 2:
        return ()
    return _decisions(tables, _realism(tables, weights), _noticing(tables, weights), margins)


def _people(tables: Tables) -> int:
    return len({*tables.ratings["participant"], *tables.comparisons["participant"]})


def _rng(model: str) -> np.random.Generator:
    """Return each model's own draws: they do not depend on which other models are fitted."""
    return np.random.default_rng([SEED, crc32(model.encode())])


def _realism(tables: Tables, weights: dict[str, float] | None) -> Realism | None:
    if not len(answered(tables.ratings)):
        return None
    return realism_of(
        tables.ratings,
        _rng("realism"),
        scale=tables.scale,
        experts=_experts(tables),
        weights=weights,
    )


def _noticing(tables: Tables, weights: dict[str, float] | None) -> Noticing | None:
    return noticing_of(tables.comparisons, tables.ratings, _rng("noticing"), weights=weights)


def _decisions(
    tables: Tables, realism: Realism | None, noticing: Noticing | None, margins: Margins
) -> tuple[Decision, ...]:
    if realism is None:
        return ()
    return tuple(decide(realism, noticing, lod_ranks(tables.ratings), margins=margins))


def _experts(tables: Tables) -> dict[str, bool]:
    """Return who works with graphics, as far as they said."""
    people = tables.participants
    if people.empty or "works_with_graphics" not in people:
        return {}
    said = people.dropna(subset=["works_with_graphics"])
    return {
        str(who): str(answer) == "yes"
        for who, answer in zip(said["participant"], said["works_with_graphics"], strict=True)
    }
