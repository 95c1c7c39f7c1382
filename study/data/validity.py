"""Validity: how many gold trials and attention questions a participant answered as expected.

An attention question counts alike on a page of its own and among a trial's questions. Data for
researchers: nobody who takes part is told, and a skipped question counts neither way.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from study.data.pauses import ATTENTION, attention_answers
from study.data.schema import EventRow
from study.data.trials import Trial, trials_of
from study.design.definition import StudyDefinition
from study.design.gold import is_passed


@dataclass(frozen=True)
class Tally:
    """How many checks of each kind were passed and failed so far."""

    gold_passed: int = 0
    gold_failed: int = 0
    attention_passed: int = 0
    attention_failed: int = 0


def tally(session: Session, participant_id: int, definition: StudyDefinition) -> Tally:
    """Return a participant's tally."""
    if not definition.gold and not definition.attention:
        return Tally()
    query = select(EventRow.kind, EventRow.payload).where(
        EventRow.participant_id == participant_id, EventRow.kind == ATTENTION
    )
    asked = attention_answers((kind, payload) for kind, payload in session.execute(query))
    return tally_of(definition, trials_of(session, participant_id), asked)


def tally_of(
    definition: StudyDefinition,
    mine: Iterable[Trial],
    attention: Mapping[str, Mapping[str, Any]],
) -> Tally:
    """Return the tally of complete trials and of answers by pause."""
    done = [trial for trial in mine if trial.is_complete]
    golds = {gold.id: gold for gold in definition.gold}
    gold = [is_passed(golds[trial.clip], trial.answers) for trial in done if trial.clip in golds]
    asked = [
        pause.attention.is_passed(attention[pause.key])
        for pause in definition.pauses
        if pause.attention is not None and pause.key in attention
    ]
    asked += [
        each.is_passed(trial.answers)
        for each in definition.attention_within
        for trial in done
        if trial.number == each.within and not trial.is_practice
    ]
    return Tally(
        gold_passed=gold.count(True),
        gold_failed=gold.count(False),
        attention_passed=asked.count(True),
        attention_failed=asked.count(False),
    )
