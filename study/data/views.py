"""Views: every play of a clip, finished or not, as the browser reports it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from study.data.at_trial import adding, check_reached, reaching
from study.data.database import Database
from study.data.errands import Errand
from study.data.events import Recorded
from study.data.participants import Participant
from study.data.senders import locking_again
from study.data.trials import PLAYED

Play = Mapping[str, Any]


def record(
    db: Database, participant: Participant, position: int, *, key: str, play: Play
) -> Recorded:
    """Add one play of a trial's clip.

    ``play`` is the player's raw record (``static/certificate.js``), kept as it came; whether the
    play counts is ``study.design.certificate``'s to say, whenever somebody asks.
    Raises NotReachedError for a trial that lies ahead.
    """

    def errand() -> Errand[Recorded]:
        who = yield from locking_again(participant)
        found = yield from recording(db, who, position, key=key, play=lambda _clip_id: play)
        return found[0]

    return db.run(errand)


def recording(
    db: Database, who: Any, position: int, *, key: str, play: Callable[[str], Play]
) -> Errand[tuple[Recorded, Play]]:
    """Add one play as ``play`` tells it, which is told the trial's ``clip_id``; returns it too."""
    trial = yield from reaching(who, position, key=key)
    told = play(trial.clip_id)
    check_reached(trial)
    if trial.is_known:
        return Recorded(False), told
    yield from adding(who, trial, key=key, kind=PLAYED, payload=told, now=db.now())
    return Recorded(True), told
