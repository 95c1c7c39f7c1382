"""Whole tables of simulated answers, without pages or a database: for tests, power and examples.

Every row says that it is simulated.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from analysis.simulation.observers import Observer, Stimulus, draw_observer
from analysis.simulation.spoilers import spoiled
from analysis.tables.columns import column_names


def simulate_tables(
    clips: Mapping[str, Stimulus],
    rng: np.random.Generator,
    *,
    participants: int,
    experts: Sequence[bool] | None = None,
    spoilers: Mapping[int, str] | None = None,
) -> dict[str, pd.DataFrame]:
    """Let ``participants`` observers each answer every clip once, in an order of their own.

    ``experts`` says for each person whether an expert; without it that is drawn too. ``spoilers``
    names the kind of those who spoil their answers, by their number from 0. Returns the tables
    ratings, comparisons and participants, ready for ``tables_from``.
    """
    ratings: list[dict[str, object]] = []
    comparisons: list[dict[str, object]] = []
    people: list[dict[str, object]] = []
    names = list(clips)
    for number in range(participants):
        observer = draw_observer(rng, is_expert=None if experts is None else experts[number])
        if spoilers and number in spoilers:
            observer = spoiled(observer, spoilers[number])
        who = {"simulated": True, "participant": f"S{number + 1:03}"}
        people.append({**who, "status": "completed", **observer.about_you(rng)})
        for position, k in enumerate(rng.permutation(len(names)), start=1):
            trial = {**who, "trial": names[k], "clip": names[k], "position": position}
            rows = _trial(observer, clips[names[k]], rng, trial)
            ratings += rows[:2]
            comparisons.append(rows[2])
    return {
        "ratings": _frame(ratings, "ratings"),
        "comparisons": _frame(comparisons, "comparisons"),
        "participants": _frame(people, "participants"),
    }


def _frame(rows: list[dict[str, object]], table: str) -> pd.DataFrame:
    names = [name for name in column_names(table) if not rows or name in rows[0]]
    return pd.DataFrame(rows, columns=names)


def _trial(
    observer: Observer, clip: Stimulus, rng: np.random.Generator, trial: dict[str, object]
) -> list[dict[str, object]]:
    answer = observer.answer(clip, rng, position=int(str(trial["position"])))
    seen = {
        **trial,
        "distance": clip.distance,
        "iris_px": clip.iris_px,
        "is_catch": clip.left_lod == clip.right_lod,
        "views": answer.views,
        "response_ms": answer.response_ms,
    }
    lods = {"left": clip.left_lod, "right": clip.right_lod}
    given = {"left": answer.left_rating, "right": answer.right_rating}
    eyes = [
        {**seen, "eye": eye, "lod": lods[eye], "other_lod": lods[other], "rating": given[eye]}
        for eye, other in (("left", "right"), ("right", "left"))
    ]
    compared = {
        **seen,
        "left_lod": clip.left_lod,
        "right_lod": clip.right_lod,
        "comparison": answer.comparison,
        "noticed": answer.noticed,
        "what_differed": answer.what_differed,
        "comments": answer.comments,
    }
    return [*eyes, compared]
