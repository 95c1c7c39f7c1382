"""The quickest way from simulated answers to verdicts: the report's models, set up once.

The report's own estimates are made once from one simulated study. Every further study of the same
plan only brings other counts: its fits start where the first ended, on its grid. People differ in
leniency alone here; their scatter and style, which the report's model has from 30 ratings a person
on, take fifteen times as long and hardly ever change a verdict (docs/power.md says how often).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.decision.effects import EffectVerdict, decide_effects
from analysis.decision.margins import Margins
from analysis.decision.verdicts import Decision, decide
from analysis.estimates.noticing import Noticing, noticing_of
from analysis.estimates.realism import Realism
from analysis.estimates.stimuli import RIGHT, Stimuli, stimuli_of
from analysis.models.counts import Counts, count_answers
from analysis.models.draws import draw
from analysis.models.fitting import fit
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.models.priors import PRIORS
from analysis.power.crowd import NOTHING, Answers
from analysis.power.plan import Integers, Plan
from analysis.power.tables import as_tables
from analysis.tables.columns import SCALE
from analysis.tables.ordering import lod_ranks


@dataclass(frozen=True)
class Decided:
    """What one study came to: LoDs with a rank along their sequence, the others one by one."""

    decisions: list[Decision]
    effects: list[EffectVerdict]

    def verdicts(self) -> list[tuple[str, str, str]]:
        """Return (distance, LoD, verdict) of every LoD that was decided on."""
        ranked = [
            (decision.distance, verdict.lod, verdict.outcome)
            for decision in self.decisions
            for verdict in decision.verdicts
        ]
        return ranked + [(own.distance, own.lod, own.outcome) for own in self.effects]


@dataclass(frozen=True)
class Prepared:
    """A plan's models, ready for counts; ``noticing`` is None where catch pairs are missing.

    ``left`` and ``right`` (n_clips,) are the numbers of a clip's eyes among the stimuli of realism,
    ``pair`` (n_clips,) that of the clip among the pairs of noticing, 0 for equal eyes.
    """

    plan: Plan
    realism: Realism
    noticing: Noticing | None
    ranks: Mapping[str, float]
    left: Integers
    right: Integers
    pair: Integers

    def decide(
        self,
        answers: Answers,
        rng: np.random.Generator,
        *,
        margins: Margins,
        seen: NDArray[np.bool_] | None = None,
    ) -> Decided:
        """Return the verdicts of one study; ``seen`` (n_presentations,) leaves out the others."""
        there = np.ones(len(self.plan.person), dtype=bool) if seen is None else seen
        realism = self.realism_of(answers, there, rng)
        noticing = self.noticing_of(answers, there, rng)
        return Decided(
            decide(realism, noticing, self.ranks, margins=margins),
            decide_effects(realism, noticing, self.ranks, levels={}, margins=margins),
        )

    def realism_of(
        self, answers: Answers, seen: NDArray[np.bool_], rng: np.random.Generator
    ) -> Realism:
        """Fit realism to one study's answers, those that were seen."""
        plan, own = self.plan, self.realism.stimuli
        person = np.concatenate([plan.person, plan.person])
        stimulus = np.concatenate([self.left[plan.clip], self.right[plan.clip]])
        rating = np.concatenate([answers.left, answers.right])
        counts = _counts(person, stimulus, rating - SCALE[0], np.tile(seen, 2), own.counts)
        found = fit(
            self.realism.fit.model,
            counts,
            priors=PRIORS,
            start=self.realism.fit.parameters,
            grid=self.realism.fit.grid,
        )
        draws = draw(found, rng, people=counts.people)
        return replace(self.realism, stimuli=replace(own, counts=counts), fit=found, draws=draws)

    def noticing_of(
        self, answers: Answers, seen: NDArray[np.bool_], rng: np.random.Generator
    ) -> Noticing | None:
        """Fit noticing to one study's answers, those that were seen."""
        known, plan = self.noticing, self.plan
        if known is None:
            return None
        counts = _counts(plan.person, self.pair[plan.clip], answers.noticed, seen, known.fit.counts)
        found = fit(
            known.fit.model,
            counts,
            priors=PRIORS,
            start=known.fit.parameters,
            grid=known.fit.grid,
        )
        return replace(known, fit=found, draws=draw(found, rng, people=counts.people))


def prepare(plan: Plan, answers: Answers, rng: np.random.Generator) -> Prepared:
    """Set the models up on one simulated study of a plan, nothing left out."""
    whole = Answers(*(np.where(a == NOTHING, 1, a) for a in answers.columns()))
    tables = as_tables(plan, whole)
    stimuli = stimuli_of(tables.ratings, scale=SCALE)
    model = OrdinalModel(
        stimuli.predictor(with_contrast=stimuli.can_tell_contrast()),
        stimuli.counts.categories,
        (LENIENCY,),
    )
    found = fit(model, stimuli.counts, priors=PRIORS)
    realism = Realism(stimuli, found, draw(found, rng, people=stimuli.counts.people))
    noticing = noticing_of(tables.comparisons, tables.ratings, rng)
    left, right = _eyes(plan, stimuli)
    return Prepared(
        plan=plan,
        realism=realism,
        noticing=noticing,
        ranks=lod_ranks(tables.ratings),
        left=left,
        right=right,
        pair=_pairs(plan, noticing),
    )


def _counts(
    person: Integers, stimulus: Integers, given: Integers, seen: NDArray[np.bool_], like: Counts
) -> Counts:
    """Count the answers that were seen and given, in tables like those of the first study."""
    kept = seen & (given >= 0)
    shape = (like.people, like.stimuli, like.categories)
    return count_answers(person[kept], stimulus[kept], given[kept], shape=shape)


def _eyes(plan: Plan, stimuli: Stimuli) -> tuple[Integers, Integers]:
    table = stimuli.table
    eyes = np.where(table[RIGHT] > 0, "right", "left")
    rows = zip(table["distance"], table["lod"], table["other_lod"], eyes, strict=True)
    place = {row: i for i, row in enumerate(rows)}
    left, right = [], []
    for clip in plan.stimuli:  # clips that none of these people see have no number
        left.append(place.get((clip.distance, clip.left_lod, clip.right_lod, "left"), 0))
        right.append(place.get((clip.distance, clip.right_lod, clip.left_lod, "right"), 0))
    return np.array(left, dtype=np.intp), np.array(right, dtype=np.intp)


def _pairs(plan: Plan, noticing: Noticing | None) -> Integers:
    place = {
        pair: i + 1
        for i, (distance, one, other) in enumerate(noticing.pairs if noticing else ())
        for pair in ((distance, one, other), (distance, other, one))
    }
    own = [place.get((c.distance, c.left_lod, c.right_lod), 0) for c in plan.stimuli]
    return np.array(own, dtype=np.intp)
