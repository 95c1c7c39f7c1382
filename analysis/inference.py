"""All models of one study's tables, fitted once: what the report's verdicts rest on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd

from analysis.decision.margins import Margins
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
    """The fitted models and the decisions; None where the tables say nothing of a model."""

    realism: Realism | None
    preference: Preference | None
    noticing: Noticing | None
    decisions: tuple[Decision, ...]
    margins: Margins

    def tables(self) -> dict[str, pd.DataFrame]:
        """Return the numbers by file name; models that could not be fitted are left out."""
        made: dict[str, pd.DataFrame] = {}
        if self.decisions:
            own = {"confidence": self.margins.confidence, "margins": self.margins.origins}
            made["decision"] = verdict_table(list(self.decisions)).assign(**own)
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
    tables: Tables, *, margins: Margins | None = None, weights: dict[str, float] | None = None
) -> Inference:
    """Fit every model that the tables allow and decide by the margins.

    Without ``margins`` by those that the study declared. ``weights`` let a participant's answers
    count for less than one.
    """
    rng = np.random.default_rng(SEED)
    margins = margins or tables.margins
    people = {*tables.ratings["participant"], *tables.comparisons["participant"]}
    if len(people) < 2:  # one person says nothing about others
        return Inference(None, None, None, (), margins)
    realism = None
    if len(answered(tables.ratings)):
        realism = realism_of(
            tables.ratings, rng, scale=tables.scale, experts=_experts(tables), weights=weights
        )
    preference = preference_of(tables.comparisons, tables.ratings, rng, weights=weights)
    noticing = noticing_of(tables.comparisons, tables.ratings, rng, weights=weights)
    decided = (
        decide(realism, noticing, lod_ranks(tables.ratings), margins=margins) if realism else []
    )
    return Inference(realism, preference, noticing, tuple(decided), margins)


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
