"""How long the clips that are left take one participant, at the pace that they keep.

Pure: from trials with their times to whole minutes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import median
from typing import Final

from study.data.trials import Trial
from study.design.definition import StudyDefinition
from study.design.duration import visit_parts

# The first trials are slower than the rest: from so many on a pace of one's own is known.
OWN_PACE_TRIALS: Final = 3


def minutes_left(
    definition: StudyDefinition, every: Sequence[Trial], *, estimate_s: float | None = None
) -> int:
    """Return how many minutes a participant's open trials take, at least one.

    Until enough trials are done it is the study's estimate; then the median of their own, which
    a long pause in one of them does not change. ``estimate_s`` is ``trial_s``, if it is known.
    """
    taken = [
        (trial.completed_at - trial.started_at).total_seconds()
        for trial in every
        if trial.completed_at is not None and trial.started_at is not None
    ]
    one_s = median(taken) if len(taken) >= OWN_PACE_TRIALS else estimate_s or trial_s(definition)
    left = sum(not trial.is_complete for trial in every)
    return max(1, math.ceil(left * one_s / 60))


def trial_s(definition: StudyDefinition) -> float:
    """Return how many seconds one trial takes, as the study file lets us expect."""
    parts = visit_parts(definition)
    trials = len(definition.practice) + definition.trial_count
    return (parts.get("watching", 0.0) + parts.get("answering", 0.0)) / trials
