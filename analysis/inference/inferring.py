"""All models of one study's tables, fitted once: what the report's verdicts rest on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pandas as pd

from analysis.costs.cost import Costs
from analysis.curves.along_sizes import NO_CURVES, Curves, curves_of
from analysis.curves.curve import curve_table, point_table, threshold_table
from analysis.decision.effects import EffectVerdict, decide_effects, levels_of
from analysis.decision.margins import Margins
from analysis.decision.pareto import ParetoPoint, pareto, pareto_table
from analysis.decision.policy import Policy
from analysis.decision.study_policy import policy_for
from analysis.decision.verdict_tables import effect_table, verdict_table
from analysis.decision.verdicts import Decision
from analysis.estimates.joint import Joint, joint_of
from analysis.estimates.linkage import Linkage, linkage_of
from analysis.estimates.noticing import Noticing
from analysis.estimates.person_effects import person_effects
from analysis.estimates.preference import Preference, preference_of
from analysis.estimates.realism import Realism
from analysis.estimates.separation import separation_warnings
from analysis.inference.deciding import (
    count_people,
    decide_by,
    experts_of,
    fit_noticing,
    fit_realism,
    rng_of,
)
from analysis.tables.ordering import lod_ranks
from analysis.tables.reading import Tables


@dataclass(frozen=True)
class Inference:
    """The fitted models and the decisions; None where the tables say nothing of a model.

    ``decisions`` are the verdicts on LoDs with a rank, ``effects`` those on LoDs without one;
    ``curves`` run along the iris's size and ``policy`` follows from them; ``pareto`` sets realism
    against cost, empty without a benchmark; ``joint`` is the scale of ratings and comparisons and
    ``linkage`` what links it.
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
    joint: Joint | None = None
    linkage: Linkage | None = None

    @property
    def best(self) -> dict[str, str]:
        """Each distance's best LoD, as far as verdicts name one."""
        named = {own.distance: own.best for own in self.effects}
        return named | {own.distance: own.best for own in self.decisions}

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
        if self.joint:
            made["joint-scale"] = self.joint.table(self.best)
        if self.realism is not None:
            made["person-effects"] = person_effects(self.realism)
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
        models = {"realism": self.realism, "preference": self.preference}
        told = [
            (name, warning)
            for name, model in {**models, "noticing": self.noticing}.items()
            if model is not None
            for warning in model.fit.warnings
        ]
        if self.realism is not None:
            told += [("realism", warning) for warning in separation_warnings(self.realism)]
        return [f"The model of {name}: {warning}." for name, warning in told]


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
    if count_people(tables) < 2:  # one person says nothing about others
        return Inference(None, None, None, (), margins, costs=costs)
    realism, noticing = fit_realism(tables, weights), fit_noticing(tables, weights)
    ranks, levels = lod_ranks(tables.ratings), levels_of(tables.ratings)
    curves = curves_of(
        tables,
        rng_of("curves"),
        margins=margins,
        ranks=margins.order(ranks),
        experts=experts_of(tables),
        weights=weights,
    )
    decisions = decide_by(tables, realism, noticing, margins)
    return Inference(
        realism=realism,
        preference=preference_of(
            tables.comparisons, tables.ratings, rng_of("preference"), weights=weights
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
        joint=(
            joint_of(realism, tables.comparisons, rng_of("joint"), weights=weights)
            if realism
            else None
        ),
        linkage=linkage_of(tables.ratings, tables.comparisons),
    )
