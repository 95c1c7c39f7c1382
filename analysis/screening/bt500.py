"""Observer screening of ITU-R BT.500: who strays from the others on both sides too often.

With few ratings one stray is already too often (1 in 14 is 7 %), so this is shown, never acted on.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.screening.presented import Presented, sums

_OFTEN: Final = 0.05  # BT.500-14 A1-2.3.1
_BOTH_SIDES: Final = 0.3


def is_rejected(shown: Presented) -> NDArray[np.bool_]:
    """Say of each person whether BT.500-14 A1-2.3.1 would reject them (n_people,).

    A rating strays beyond 2 standard deviations of its stimulus where their distribution looks
    normal (kurtosis 2 to 4), beyond sqrt(20) elsewhere. Stimuli that all rated alike tell nothing.
    """
    n_people, n_stimuli = len(shown.people), int(shown.stimulus.max(initial=-1)) + 1
    u, at = shown.rating, shown.stimulus
    count = sums(at, np.ones_like(u), n_stimuli)
    away = u - (sums(at, u, n_stimuli) / count)[at]
    second, fourth = (sums(at, away**power, n_stimuli) / count for power in (2, 4))
    tells = second > 1e-12
    kurtosis = np.divide(fourth, second**2, out=np.zeros(n_stimuli), where=tells)
    reach = np.where((kurtosis >= 2) & (kurtosis <= 4), 2.0, np.sqrt(20.0)) * np.sqrt(second)
    limit = np.where(tells, reach, np.inf)[at]
    above = sums(shown.person, (away >= limit).astype(float), n_people)
    below = sums(shown.person, (away <= -limit).astype(float), n_people)
    strays = above + below
    imbalance = np.divide(np.abs(above - below), strays, out=np.ones(n_people), where=strays > 0)
    return np.asarray((strays / shown.answers > _OFTEN) & (imbalance < _BOTH_SIDES))
