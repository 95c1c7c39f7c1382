"""A simulated study's arrays as the tables that the analysis takes: as an export holds them."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.power.crowd import NOTHING, Answers
from analysis.power.plan import Integers, Plan
from analysis.tables.columns import NOTICED
from analysis.tables.reading import Tables, tables_from

_GRADES: Final = tuple(reversed(NOTICED))  # no, unsure, yes: as the crowd's answers number them


def as_tables(plan: Plan, answers: Answers, *, seen: NDArray[np.bool_] | None = None) -> Tables:
    """Return a simulated study as the analysis takes it; directions and experts are left out."""
    there = np.ones(len(plan.person), dtype=bool) if seen is None else seen
    names, stimuli = list(plan.clips), plan.stimuli
    rows = pd.DataFrame(
        {
            "simulated": True,
            "participant": [f"S{number + 1:04}" for number in plan.person],
            "trial": [str(number) for number in range(len(plan.person))],
            "clip": [names[k] for k in plan.clip],
            "position": plan.position,
            "distance": [stimuli[k].distance for k in plan.clip],
            "iris_px": [stimuli[k].iris_px for k in plan.clip],
            "left_lod": [stimuli[k].left_lod for k in plan.clip],
            "right_lod": [stimuli[k].right_lod for k in plan.clip],
        }
    )
    compared = rows.assign(
        comparison=_known(answers.comparison),
        noticed=pd.Series(answers.noticed).map(dict(enumerate(_GRADES))),
    )[there]
    eyes = [
        rows.rename(columns={f"{eye}_lod": "lod", f"{other}_lod": "other_lod"})
        .assign(eye=eye, rating=_known(given))[there]
        .reset_index(drop=True)
        for eye, other, given in (("left", "right", answers.left), ("right", "left", answers.right))
    ]
    ratings = pd.concat(eyes, ignore_index=True)
    return tables_from({"ratings": ratings, "comparisons": compared.reset_index(drop=True)})


def _known(given: Integers) -> pd.Series:
    return pd.Series(given).astype("Int64").mask(given == NOTHING)
