"""Did a person look? How likely their answers are if so, if not, and with the scale turned round.

Three accounts of all answers of a person are held against each other, by what others answer:

    looked       each trial's answers are those to what it showed
    did not      each is an answer to any of the trials that the person was shown
    turned       ratings and comparisons run backwards, what is noticed does not

Each is a probability of the same answers, averaged over how lenient the person may be. Were it
exact, at most one in k of the people who looked would have answers that are k times likelier
otherwise, whatever the study (Markov's inequality); docs/power.md says how few do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.polynomial.hermite_e import hermegauss
from scipy.special import logsumexp

from analysis.screening.others import Others, others_of
from analysis.screening.presented import Floats, Places
from analysis.screening.trials import COMPARED, NONE, NOTED, QUESTIONS, RATED, Trials, trials_of
from analysis.tables.reading import Tables

LEAST: Final = 0.1
"""Weight of a person who surely did not look: still there, and too light to move a verdict."""

_FEWEST_TRIALS: Final = 5
_FEWEST_PEOPLE: Final = 5  # fewer cannot say what others answer
_LENIENCE_SD: Final = 1.0  # of people, beside the scatter of all answers, which is 1: wide
_NODES, _WEIGHTS = hermegauss(9)
_LENIENCE: Final = _LENIENCE_SD * _NODES
_APART: Final = 0.7
"""What a trial's answer is worth beside independent ones: all four of them come of one look.

By simulation: without it four times as many people who looked are named.
"""
_LOG_WEIGHTS: Final = np.log(_WEIGHTS / _WEIGHTS.sum())


@dataclass(frozen=True)
class Evidence:
    """Per person (n_people,), logarithms of odds; nan where nothing can be told.

    ``looking``: that they looked, against that they did not; ``upright``: that they looked, against
    that the scale is turned round.
    """

    people: tuple[str, ...]
    looking: Floats
    upright: Floats

    def weights(self) -> Floats:
        """Return 1 / k for whose answers are k times likelier otherwise, at least LEAST."""
        return weights_of(np.fmin(self.looking, self.upright))


def weights_of(log_odds: Floats) -> Floats:
    """Return a weight that falls with the odds below 1, from 1 to LEAST; 1 where unknown."""
    return np.clip(np.exp(np.minimum(np.nan_to_num(log_odds, nan=0.0), 0.0)), LEAST, 1.0)


def evidence_of(tables: Tables) -> Evidence:
    """Return how everybody's answers go with what they were shown.

    Found twice: whoever seems not to look at first counts less among the others the second time.
    """
    trials = trials_of(tables)
    found = Evidence(trials.people, *np.full((2, len(trials.people)), np.nan))
    if len(trials.people) < _FEWEST_PEOPLE:
        return found
    counts = {kind: trials.counts(kind) for kind in (RATED, COMPARED, NOTED)}
    for _ in range(2):
        often = found.weights()[:, None, None]
        found = _found(trials, {kind: others_of(own * often) for kind, own in counts.items()})
    return found


def _found(trials: Trials, others: dict[str, Others]) -> Evidence:
    odds = np.full((2, len(trials.people)), np.nan)
    order = np.argsort(trials.person, kind="stable")
    ends = np.searchsorted(trials.person[order], np.arange(len(trials.people) + 1))
    for person in range(len(trials.people)):
        own = order[ends[person] : ends[person + 1]]
        own = own[(trials.given[own] != NONE).any(axis=1)]
        if len(own) >= _FEWEST_TRIALS:
            odds[:, person] = _odds(trials, others, person, own)
    return Evidence(trials.people, *odds)


def _odds(
    trials: Trials, others: dict[str, Others], person: int, own: Places
) -> tuple[float, float]:
    """Return both log odds from the trials ``own`` of one person."""
    count = len(own)
    as_shown = np.zeros((len(_LENIENCE), count, count))  # a trial's answers, as another's
    turned = np.zeros((len(_LENIENCE), count))
    for question, kind in enumerate(QUESTIONS):
        shares = others[kind].log_shares(person, _LENIENCE if kind == RATED else np.zeros(1))
        place, given = trials.place[own, question], trials.given[own, question]
        shares *= _APART
        is_given, last = given != NONE, trials.categories[kind] - 1
        if not is_given.any():
            continue
        answer = np.broadcast_to(np.maximum(given, 0)[:, None], (count, count))
        if kind == COMPARED:  # as the pair of the trial in the column names it
            answer = np.where(trials.is_mirrored[own], last - answer, answer)
        told = shares[:, np.maximum(place, 0), answer]
        nowhere = (
            _APART * np.log(others[kind].shares[person])[answer]
        )  # the other trial did not ask
        as_shown += np.where(is_given[:, None], np.where(place != NONE, told, nowhere), 0.0)
        backwards = np.diagonal(answer if kind == NOTED else last - answer)
        turned += np.where(is_given, shares[:, np.maximum(place, 0), backwards], 0.0)
    looked = _averaged(np.trace(as_shown, axis1=1, axis2=2))
    did_not = _averaged((logsumexp(as_shown, axis=2) - np.log(count)).sum(axis=1))
    return looked - did_not, looked - _averaged(turned.sum(axis=1))


def _averaged(log_likelihood: Floats) -> float:
    return float(logsumexp(log_likelihood + _LOG_WEIGHTS))
