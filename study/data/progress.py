"""Where a participant is. The server knows, so reload, back and coming back all lead there.

The steps before the trials are stamps on the participant, set in the transaction that records the
event; after that the first trial that is not complete is the current one.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

from study.data import pauses, trials
from study.data.checks import CHECKS, doing, wanted
from study.data.database import Database
from study.data.errands import Errand
from study.data.participants import Participant, finding
from study.data.studies import by_id
from study.data.trials import Trial
from study.design.definition import StudyDefinition
from study.design.pauses import Pause

StepName = Literal[
    "consent",
    "about",
    "device_check",
    "calibration",
    "eyesight",
    "instructions",
    "preparing",
    "practice",
    "trial",
    "pause",
    "thanks",
    "screened_out",
    "withdrawn",
]
STEPS: Final[tuple[StepName, ...]] = (
    *("consent", "about"),
    *CHECKS,
    *("instructions", "preparing", "practice", "trial", "thanks"),
    *("screened_out", "withdrawn"),
)
SCREENED_OUT: Final = "screened_out"
"""The outcome of somebody who cannot take part, and the name of that step and its event."""


@dataclass(frozen=True)
class Step:
    """What to show now; at "practice" and "trial" the ``number``-th trial of ``total``.

    At a "pause" ``number`` of ``total`` trials are done.
    """

    name: StepName
    trial: Trial | None = None
    number: int = 0
    total: int = 0
    pause: Pause | None = None


def current_step(db: Database, participant: Participant) -> Step:
    """Return where a participant is, read from the database."""
    definition = by_id(db, participant.study_id).definition
    return db.look(lambda: _stepping(participant, definition))


def _stepping(participant: Participant, definition: StudyDefinition) -> Errand[Step]:
    who = yield from finding("id", participant.id)
    if who is None or who.public_id != participant.public_id:
        return Step("withdrawn")
    return (yield from stepping(who, definition))


def stepping_on(participant_id: int, definition: StudyDefinition) -> Errand[Step]:
    """Return where somebody is now that something was written about them."""
    who = yield from finding("id", participant_id)
    return (yield from stepping(who, definition))


def stepping(who: Any, definition: StudyDefinition) -> Errand[Step]:
    """Return where somebody is; ``who`` is their row."""
    done = () if who.instructed_at else (yield from doing(who, definition))
    early = early_step(who, definition, done)
    if early is not None:
        return Step(early)
    mine = yield from trials.reading(who)
    pause = yield from pauses.pausing(who, definition, mine)
    return step_among(mine, pause)


def standing(
    who: Any, definition: StudyDefinition
) -> Errand[tuple[Step, tuple[Trial, ...]] | None]:
    """Return where somebody is among the trials, and these; ``who`` is their row.

    It is what ``current_step`` returns, as an errand; None for somebody before the trials.
    """
    if who.instructed_at is None or early_step(who, definition, ()) is not None:
        return None
    mine = yield from trials.reading(who)
    pause = yield from pauses.pausing(who, definition, mine)
    return step_among(mine, pause), mine


def step_among(mine: Sequence[Trial], pause: Pause | None) -> Step:
    """Return the step of somebody who has begun, at the ``pause`` if one is due."""
    open_trial = next((trial for trial in mine if not trial.is_complete), None)
    if open_trial is None:
        return Step("thanks")
    alike = [trial for trial in mine if trial.is_practice == open_trial.is_practice]
    if pause is not None:
        return Step("pause", None, open_trial.number - 1, len(alike), pause)
    name: StepName = "practice" if open_trial.is_practice else "trial"
    return Step(name, open_trial, open_trial.number, len(alike))


def early_step(row: Any, definition: StudyDefinition, done: Collection[str]) -> StepName | None:
    """Return the step of someone who has not begun the trials, or None.

    ``done`` are the checks before the clips that are done (``study.data.checks``).
    """
    if row.outcome == SCREENED_OUT:
        return "screened_out"
    if row.consented_at is None:
        return "consent"
    if row.about_at is None and definition.about:
        return "about"
    if row.instructed_at is None:
        open_checks = (name for name in wanted(definition) if name not in done)
        return next(open_checks, "instructions")
    return "preparing" if row.begun_at is None else None
