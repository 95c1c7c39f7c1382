"""What a chart may draw from: the tables, and what was concluded from them once for all charts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from analysis.costs.cost import Costs
from analysis.diagnostics.predicted import predicted_shares
from analysis.diagnostics.residuals import quantile_residuals
from analysis.inference.deciding import rng_of
from analysis.inference.inferring import Inference, infer
from analysis.inference.leaving_out import verdicts_without_each
from analysis.inference.leaving_out_effects import effects_without_each
from analysis.screening.flags import flags_of
from analysis.screening.signals import observer_signals
from analysis.screening.weights import observer_weights
from analysis.tables.reading import Tables


@dataclass(frozen=True)
class Material:
    """One study's tables, their costs, and what follows from them, worked out when first needed.

    ``inferred``, ``sensitivity`` (the verdicts without flagged people), ``diagnosed`` (the quantile
    residuals) and ``predicted`` (shares of the scale's ends) are what the report has worked out
    already.
    """

    tables: Tables
    costs: Costs | None = None
    inferred: Inference | None = None
    sensitivity: pd.DataFrame | None = None
    diagnosed: pd.DataFrame | None = None
    predicted: pd.DataFrame | None = None

    @property
    def is_simulated(self) -> bool:
        """Whether the answers come from simulated observers."""
        return self.tables.is_simulated

    @cached_property
    def signals(self) -> pd.DataFrame:
        """What each person's answers show."""
        return observer_signals(self.tables)

    @cached_property
    def flags(self) -> dict[str, tuple[str, ...]]:
        """The flags of every person who has any."""
        return flags_of(self.signals)

    @cached_property
    def inference(self) -> Inference:
        """The fitted models and verdicts."""
        if self.inferred is not None:
            return self.inferred
        weights = observer_weights(self.signals)
        return infer(self.tables, weights=weights or None, costs=self.costs)

    @cached_property
    def residuals(self) -> pd.DataFrame:
        """The ratings' randomised quantile residuals; empty without a model."""
        realism = self.inference.realism
        if self.diagnosed is not None or realism is None:
            return pd.DataFrame() if self.diagnosed is None else self.diagnosed
        return quantile_residuals(realism, rng_of("residuals"))

    @cached_property
    def ends(self) -> pd.DataFrame:
        """How often the scale's ends were given and the model expects them; empty without one."""
        realism = self.inference.realism
        if self.predicted is not None or realism is None:
            return pd.DataFrame() if self.predicted is None else self.predicted
        return predicted_shares(realism, rng_of("predicted"))

    @cached_property
    def left_out(self) -> pd.DataFrame:
        """Every verdict without each person, whoever it is."""
        own = self.inference
        rows = self.tables.comparisons
        parts = (
            verdicts_without_each(own.decisions, own.realism, own.noticing, comparisons=rows),
            effects_without_each(own.effects, own.realism, own.noticing, comparisons=rows),
        )
        told = [part for part in parts if len(part)]
        return pd.concat(told, ignore_index=True) if told else parts[0]
