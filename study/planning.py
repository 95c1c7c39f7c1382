"""A study definition as the plain plan that ``analysis.power`` simulates: who sees what."""

from __future__ import annotations

import pandas as pd

from analysis.power.plan import COLUMNS, Plan
from study.answering import stimulus
from study.design.definition import StudyDefinition
from study.design.exposure import visits


def plans_of(
    definition: StudyDefinition, people: int, *, seed: int, count: int
) -> tuple[Plan, ...]:
    """Return ``count`` ways in which so many people may come, each by the study's own schedule.

    The pictures' first size counts. Practice and gold trials are left out, as in every analysis.
    """
    size, orbit = str(definition.sizes[0]), definition.orbit.directions[0]
    clips = {
        clip.id: stimulus(definition, clip.id, size=size, orbit=orbit)
        for clip in definition.trial_clips
    }
    return tuple(
        Plan(clips, _table(definition, people, seed=seed + number)) for number in range(count)
    )


def _table(definition: StudyDefinition, people: int, *, seed: int) -> pd.DataFrame:
    rows = [
        (person, position, clip.id)
        for person, visit in enumerate(visits(definition, people, seed=seed))
        for position, clip in enumerate(visit.clips, start=1)
    ]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def studied_lods(definition: StudyDefinition) -> tuple[str, ...]:
    """Return the LoDs that trials show, in the file's order; practice and gold do not count."""
    shown = {lod for clip in definition.trial_clips for lod in (clip.left, clip.right)}
    return tuple(lod for lod in definition.lods if lod in shown)
