"""Did a person look? How much better their answers go with what they saw than with another trial.

Whoever answers without looking might as well have been shown their trials in another order. So all
answers of a trial together (both ratings, the comparison, what was noticed) are held against what
others answered to the same, and the fit against that of the same answers dealt out at random: its
mean and variance over all orders are known (Hoeffding 1951, Ann. Math. Statist. 22:558).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.screening.following import others_means
from analysis.screening.presented import Floats, Places, Presented, sums
from analysis.tables.columns import NOTICED
from analysis.tables.reading import Tables

LEFT, RIGHT, COMPARED, NOTED = "left", "right", "comparison", "noticed"
_VALUES: Final = (LEFT, RIGHT, COMPARED)
_QUESTIONS: Final = (*_VALUES, NOTED)
_LEAST_SCATTER: Final = 0.05  # of answers about the others' mean: nobody is trusted without bound
_FEWEST_TRIALS: Final = 5


@dataclass(frozen=True)
class Evidence:
    """Per person (n_people,), in standard deviations of chance; nan where nothing can be told.

    ``looking`` takes all answers, ``valuing`` ratings and comparisons alone, ``noticing`` what was
    noticed: 0 is what not looking gives, below zero the scale is turned round.
    """

    people: tuple[str, ...]
    looking: Floats
    valuing: Floats
    noticing: Floats


@dataclass(frozen=True)
class _Trials:
    """Every trial's answers and what others answered, centred on the person's; missing is 0.

    ``given`` and ``expected`` are (n_trials, n_questions); ``precision`` (n_questions,) is one over
    the scatter of people's answers about the others' mean.
    """

    people: tuple[str, ...]
    person: Places
    given: Floats
    expected: Floats
    precision: Floats


def evidence_of(tables: Tables) -> Evidence:
    """Return how far everybody's answers go with what they were shown."""
    trials = _trials(tables)
    return Evidence(
        trials.people,
        looking=_fit(trials, _QUESTIONS),
        valuing=_fit(trials, _VALUES),
        noticing=_fit(trials, (NOTED,)),
    )


def _fit(trials: _Trials, questions: tuple[str, ...]) -> Floats:
    """Return the fit's distance from its mean over all orders, in its standard deviations.

    With a trial's answers y and the others' x, both centred on the person's mean, it is sum y'Wx;
    over all orders its mean is 0 and its variance sum of (y_s'W x_t)^2 over all s, t / (n - 1).
    """
    kept = [_QUESTIONS.index(question) for question in questions]
    x = trials.expected[:, kept] * trials.precision[kept]
    y = trials.given[:, kept]
    count = len(trials.people)

    def total(values: Floats) -> Floats:
        return sums(trials.person, values, count)

    fit = total((x * y).sum(axis=1))
    square = np.zeros(count)
    for i in range(len(kept)):
        for j in range(len(kept)):
            square += total(x[:, i] * x[:, j]) * total(y[:, i] * y[:, j])
    n = total(np.ones(len(x)))
    known = (n >= _FEWEST_TRIALS) & (square > 1e-9)
    z = np.full(count, np.nan)
    np.divide(fit, np.sqrt(square / np.maximum(n - 1, 1)), out=z, where=known)
    return z


def _trials(tables: Tables) -> _Trials:
    rows = pd.concat([_rated(tables), _compared(tables), _noted(tables)], ignore_index=True)
    rows["expected"] = _others(rows)
    rows = rows.dropna(subset=["expected"])
    own = ["participant", "question"]
    for name in ("given", "expected"):
        rows[name] = rows[name] - rows.groupby(own)[name].transform("mean")
    trials = rows.drop_duplicates(["participant", "trial"])
    person, people = pd.factorize(trials["participant"], sort=True)
    place = (
        rows.groupby(["participant", "trial"], sort=False).ngroup().to_numpy(),
        rows["question"].map({name: i for i, name in enumerate(_QUESTIONS)}).to_numpy(dtype=int),
    )
    both = np.zeros((2, len(trials), len(_QUESTIONS)))
    for table, name in zip(both, ("given", "expected"), strict=True):
        table[place] = rows[name].to_numpy(dtype=float)
    return _Trials(
        people=tuple(map(str, people)),
        person=np.asarray(person, dtype=np.intp),
        given=both[0],
        expected=both[1],
        precision=_precision(rows),
    )


def _others(rows: pd.DataFrame) -> Floats:
    """Return what others answered at the same place, each question for itself."""
    expected = np.full(len(rows), np.nan)
    for kind in rows["kind"].unique():
        mine = (rows["kind"] == kind).to_numpy()
        own = rows[mine]
        person, people = pd.factorize(own["participant"], sort=True)
        place, _ = pd.factorize(own["place"])
        place = np.asarray(place, dtype=np.intp)
        answers = own["given"].to_numpy(dtype=float)
        shown = Presented(
            tuple(map(str, people)), np.asarray(person, dtype=np.intp), place, place, answers
        )
        expected[mine] = others_means(shown, place)
    return expected


def _precision(rows: pd.DataFrame) -> Floats:
    """Return one over the median person's mean squared distance from the others, by question."""
    away = (rows["given"] - rows["expected"]) ** 2
    scatter = away.groupby([rows["kind"], rows["participant"]]).mean().groupby(level=0).median()
    kinds = {LEFT: "rating", RIGHT: "rating"}
    found = [float(scatter.get(kinds.get(name, name), np.inf)) for name in _QUESTIONS]
    return np.asarray(1.0 / np.maximum(found, _LEAST_SCATTER), dtype=float)


def _rated(tables: Tables) -> pd.DataFrame:
    rows = _counted(tables.ratings, "rating")
    eye = rows["eye"].astype("object").where(rows["eye"].notna(), LEFT)
    place = rows["distance"].astype(str) + "|" + rows["lod"].astype(str)
    return _frame(rows, rows["rating"], place=place, question=eye, kind="rating")


def _compared(tables: Tables) -> pd.DataFrame:
    rows = _counted(tables.comparisons, "comparison")
    place = rows["distance"].astype(str) + "|" + rows["left_lod"] + "|" + rows["right_lod"]
    return _frame(rows, rows["comparison"], place=place, question=COMPARED, kind=COMPARED)


def _noted(tables: Tables) -> pd.DataFrame:
    rows = _counted(tables.comparisons, "noticed")
    pairs = zip(rows["distance"], rows["left_lod"], rows["right_lod"], strict=True)
    place = [f"{distance}|{'|'.join(sorted((left, right)))}" for distance, left, right in pairs]
    grade = rows["noticed"].astype("object").map(dict(zip(NOTICED, (2, 1, 0), strict=True)))
    return _frame(rows, grade, place=place, question=NOTED, kind=NOTED)


def _counted(rows: pd.DataFrame, question: str) -> pd.DataFrame:
    return rows[(rows[question].notna() & ~rows["is_practice"]).to_numpy(dtype=bool)]


def _frame(
    rows: pd.DataFrame, given: pd.Series, *, place: object, question: object, kind: str
) -> pd.DataFrame:
    """Name the trial; a rating that tells none is a trial of its own."""
    alone = pd.Series([f"{kind} {i}" for i in range(len(rows))], index=rows.index)
    return pd.DataFrame(
        {
            "participant": rows["participant"].astype(str),
            "trial": rows["trial"].astype("object").where(rows["trial"].notna(), alone),
            "given": given.astype(float),
            "place": place,
            "question": question,
            "kind": kind,
        }
    )


def typical(values: Floats) -> tuple[float, float]:
    """Return the median person's evidence and people's robust sd; nan, nan for fewer than three."""
    known: NDArray[np.float64] = values[np.isfinite(values)]
    if len(known) < 3:
        return np.nan, np.nan
    middle = float(np.median(known))
    return middle, 1.4826 * float(np.median(np.abs(known - middle)))
