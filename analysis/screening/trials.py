"""Every trial as four answers to what was shown: both ratings, the comparison, what was noticed.

A question's place is what its answer should depend on: a rating's the LoD at the distance, a
comparison's and a noticing's the pair of LoDs there, whichever stood left. A comparison's answer is
told from the pair's first name in the alphabet, so that both ways round share a place.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.screening.presented import Floats, Places
from analysis.tables.columns import NOTICED
from analysis.tables.reading import Tables

RATED, COMPARED, NOTED = "rated", "compared", "noted"
QUESTIONS: Final = (RATED, RATED, COMPARED, NOTED)  # of one trial: left, right, comparison, noticed
_LEFT, _RIGHT, _COMPARISON, _NOTICED = range(len(QUESTIONS))
NONE: Final = -1


@dataclass(frozen=True)
class Trials:
    """What everybody was shown and answered.

    ``person`` (n_trials,); ``place`` and ``given`` (n_trials, 4) in the order of QUESTIONS, NONE
    where there is none; answers number from 0. ``is_mirrored`` (n_trials,): the pair's second name
    stood left. ``categories`` are the answers that each kind of question has.
    """

    people: tuple[str, ...]
    person: Places
    place: Places
    given: Places
    is_mirrored: NDArray[np.bool_]
    categories: dict[str, int]

    def counts(self, kind: str) -> Floats:
        """Count answers by person, place and category (n_people, n_places, n_categories)."""
        own = [i for i, name in enumerate(QUESTIONS) if name == kind]
        shape = (len(self.people), int(self.place[:, own].max(initial=-1)) + 1)
        found: Floats = np.zeros((*shape, self.categories[kind]))
        for i in own:
            given = self.given_at(i)
            kept = (given != NONE) & (self.place[:, i] != NONE)
            np.add.at(found, (self.person[kept], self.place[kept, i], given[kept]), 1.0)
        return found

    def given_at(self, question: int) -> Places:
        """Return a question's answers, a comparison's as told from the pair's first name."""
        given = self.given[:, question]
        if QUESTIONS[question] != COMPARED:
            return given
        return np.where(self.is_mirrored & (given != NONE), mirrored(given), given)


def mirrored(comparison: Places) -> Places:
    """Return comparisons (0, 1, 2) as seen from the other side."""
    return 2 - comparison


def trials_of(tables: Tables) -> Trials:
    """Read every trial that counts from the tables; a rating that tells no trial is one itself."""
    rows = pd.concat([_rated(tables), _compared(tables), _noticed(tables)], ignore_index=True)
    person, people = pd.factorize(rows["participant"], sort=True)
    trial = rows.groupby([person, "trial"], sort=False).ngroup().to_numpy()
    for name in (RATED, COMPARED, NOTED):
        own = rows["question"].map(dict(enumerate(QUESTIONS))) == name
        rows.loc[own, "number"] = pd.factorize(rows.loc[own, "place"], sort=True)[0]
    count = int(trial.max(initial=-1)) + 1
    at = (trial, rows["question"].to_numpy(dtype=np.intp))
    place, given = (np.full((count, len(QUESTIONS)), NONE, dtype=np.intp) for _ in range(2))
    place[at] = rows["number"].to_numpy(dtype=np.intp)
    given[at] = rows["given"].fillna(NONE).to_numpy(dtype=np.intp)
    whose, is_mirrored = np.zeros(count, dtype=np.intp), np.zeros(count, dtype=bool)
    whose[trial] = person
    is_mirrored[trial] |= rows["is_mirrored"].to_numpy(dtype=bool)
    low, high = tables.scale
    categories = {RATED: high - low + 1, COMPARED: 3, NOTED: len(NOTICED)}
    return Trials(tuple(map(str, people)), whose, place, given, is_mirrored, categories)


def _rated(tables: Tables) -> pd.DataFrame:
    rows = tables.ratings[~tables.ratings["is_practice"]]
    place = rows["distance"].astype(str) + "|" + rows["lod"].astype(str)
    question = np.where(rows["eye"].astype("object") == "right", _RIGHT, _LEFT)
    given = rows["rating"].astype(float) - tables.scale[0]
    return _frame(rows, given, place=place, question=question, kind=RATED)


def _compared(tables: Tables) -> pd.DataFrame:
    rows = tables.comparisons[~tables.comparisons["is_practice"]]
    given = rows["comparison"].astype(float) + 1.0
    made = _frame(rows, given, place=_pair(rows), question=_COMPARISON, kind=COMPARED)
    return made.assign(is_mirrored=_is_mirrored(rows))


def _noticed(tables: Tables) -> pd.DataFrame:
    rows = tables.comparisons[~tables.comparisons["is_practice"]]
    grade = {word: float(i) for i, word in enumerate(reversed(NOTICED))}
    given = rows["noticed"].astype("object").map(grade).astype(float)
    made = _frame(rows, given, place=_pair(rows), question=_NOTICED, kind=COMPARED)
    return made.assign(is_mirrored=_is_mirrored(rows))


def _is_mirrored(rows: pd.DataFrame) -> NDArray[np.bool_]:
    return (rows["left_lod"] > rows["right_lod"]).to_numpy(dtype=bool)


def _pair(rows: pd.DataFrame) -> pd.Series:
    away = _is_mirrored(rows)
    left, right = rows["left_lod"].astype(str), rows["right_lod"].astype(str)
    first, second = left.where(~away, right), right.where(~away, left)
    return rows["distance"].astype(str) + "|" + first + "|" + second


def _frame(
    rows: pd.DataFrame, given: pd.Series, *, place: pd.Series, question: object, kind: str
) -> pd.DataFrame:
    alone = pd.Series([f"{kind} {i}" for i in range(len(rows))], index=rows.index)
    return pd.DataFrame(
        {
            "participant": rows["participant"].astype(str),
            "trial": rows["trial"].astype("object").where(rows["trial"].notna(), alone),
            "given": given,
            "place": place,
            "question": question,
            "number": NONE,
            "is_mirrored": False,
        }
    )
