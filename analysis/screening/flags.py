"""Named flags for people whose answers spoil data, and what each flag means.

A flag is raised where the answers say it clearly; few ratings seldom do. One pattern is named once:
"shuffler" is kept for those whom no other name fits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import log
from typing import Final

import numpy as np
import pandas as pd

SHUFFLER, STRAIGHT_LINER, EXTREME = "shuffler", "straight-liner", "extreme"
INVERTER, SIDE_PICKER, FALSE_ALARMS = "inverter", "side-picker", "false alarms"

_FEW: Final = 6  # ratings or comparisons below which a pattern of use says nothing
_NEARLY_ALL: Final = 0.9
_FEW_AGAINST: Final = 3
NAMED: Final = 5.0
"""How many times likelier answers must be from somebody who did not look, or who turned the scale.

Of simulated people who looked few are named (docs/power.md), and nobody where not even the median
person is told as clearly to have looked.
"""
_LOG_NAMED: Final = log(NAMED)


@dataclass(frozen=True)
class Flag:
    """One flag: its name, its meaning for a reader, and whom it concerns (signals -> booleans)."""

    name: str
    meaning: str
    concerns: Callable[[pd.DataFrame], pd.Series]


def _is_straight(s: pd.DataFrame) -> pd.Series:
    whole = (s["same_share"] >= 1) & (s["ratings"] >= _FEW)
    return whole | ((s["same_share"] >= 0.95) & (s["ratings"] >= 3 * _FEW))


def _is_extreme(s: pd.DataFrame) -> pd.Series:
    uses_both = s["same_share"] < 0.95
    return (s["ends_share"] >= _NEARLY_ALL) & (s["ratings"] >= _FEW) & uses_both


def _is_side_picker(s: pd.DataFrame) -> pd.Series:
    always = (s["side_share"] >= _NEARLY_ALL) & (s["compared"] >= _FEW)
    return always & (s["against_share"] >= 0.8) & (s["against"] >= _FEW_AGAINST)


def _is_inverter(s: pd.DataFrame) -> pd.Series:
    """Turned round fits, and better than answers without looking do."""
    return _is_unlikely(s["upright"]) & s["upright"].lt(s["looking"])


def _is_shuffler(s: pd.DataFrame) -> pd.Series:
    return _is_unlikely(s["looking"])


def _is_unlikely(log_odds: pd.Series) -> pd.Series:
    return log_odds.lt(-_LOG_NAMED) & bool(log_odds.median() > _LOG_NAMED)


def _has_false_alarms(s: pd.DataFrame) -> pd.Series:
    return s["alarms_low"] > 0.5


FLAGS: Final = (
    Flag(STRAIGHT_LINER, "gave nearly every eye the same rating", _is_straight),
    Flag(EXTREME, "used almost only the two ends of the scale", _is_extreme),
    Flag(SIDE_PICKER, "preferred the same side whatever stood there", _is_side_picker),
    Flag(INVERTER, "rated high what others rated low", _is_inverter),
    Flag(SHUFFLER, "answers have nothing to do with what was shown", _is_shuffler),
    Flag(FALSE_ALARMS, "saw differences between equal eyes more often than not", _has_false_alarms),
)


def flags_of(signals: pd.DataFrame) -> dict[str, tuple[str, ...]]:
    """Return the flags of every person who has any, by participant."""
    raised = {flag.name: flag.concerns(signals).fillna(False).to_numpy(bool) for flag in FLAGS}
    named = np.any([raised[name] for name in (STRAIGHT_LINER, EXTREME, SIDE_PICKER)], axis=0)
    raised[INVERTER] = raised[INVERTER] & ~named
    raised[SHUFFLER] = raised[SHUFFLER] & ~(named | raised[INVERTER])
    found = {
        str(who): tuple(name for name, is_so in raised.items() if is_so[i])
        for i, who in enumerate(signals["participant"])
    }
    return {who: flags for who, flags in found.items() if flags}


def typical_slope(signals: pd.DataFrame) -> float:
    """Return the median slope on the others' means; 0 where there is none or it is negative.

    It lies below 1 where few others rated a cell, because their mean is then noisy itself.
    """
    known = signals["slope"].dropna()
    return max(float(known.median()), 0.0) if len(known) > 2 else 0.0
