"""Three verdicts on every LoD against the highest one shown: equivalent, different, not shown.

A LoD is equivalent where both hold with the stated confidence: its realism is not lower than the
highest LoD's by the margin (non-inferiority), and it is not noticed beside it more often than the
margin beyond false alarms. That no difference was found is no proof of equality: then the verdict
is "not shown". Within a distance LoDs are tested from the highest down, stopping at the first that
fails, which keeps the error of the whole sequence at that of one test.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.decision.margins import DEFAULT, Margins
from analysis.estimates.noticing import Noticing
from analysis.estimates.realism import Realism

Floats = NDArray[np.float64]
EQUIVALENT, DIFFERENT, NOT_SHOWN = "equivalent", "different", "not shown"


@dataclass(frozen=True)
class Test:
    """One quantity against its margin: the estimate, its one-sided bounds, whether it passes.

    ``fails`` is True where the lower bound lies beyond the margin: shown to be too much.
    ``p_beyond`` is the p value of "it is beyond the margin", ``p_within`` that of "it is not".
    """

    value: float
    low: float
    high: float
    margin: float
    p_beyond: float = np.nan
    p_within: float = np.nan

    @property
    def passes(self) -> bool:
        """Whether the upper bound lies below the margin."""
        return self.high < self.margin

    @property
    def fails(self) -> bool:
        """Whether the lower bound lies above the margin."""
        return self.low > self.margin


@dataclass(frozen=True)
class Verdict:
    """One LoD at one distance against the highest LoD there.

    ``noticed`` is None where the data cannot tell. ``is_reached`` is False for LoDs after the first
    that failed: they were not tested, and so nothing is shown for them.
    """

    distance: str
    lod: str
    best: str
    realism: Test
    noticed: Test | None
    is_reached: bool
    share_cheapest: float

    @property
    def outcome(self) -> str:
        """One of the three verdicts."""
        tests = [self.realism, *([self.noticed] if self.noticed else [])]
        if any(test.fails for test in tests):
            return DIFFERENT
        passed = self.noticed is not None and all(test.passes for test in tests)
        return EQUIVALENT if passed and self.is_reached else NOT_SHOWN


@dataclass(frozen=True)
class Decision:
    """The answer at one distance; ``lod`` is the cheapest that was shown to be enough.

    ``best_share`` is the share of draws in which only the highest LoD is enough.
    """

    distance: str
    best: str
    lod: str
    verdicts: tuple[Verdict, ...]
    best_share: float


def decide(
    realism: Realism,
    noticing: Noticing | None,
    ranks: Mapping[str, float],
    *,
    margins: Margins = DEFAULT,
) -> list[Decision]:
    """Decide at every distance at which the highest LoD was rated beside others.

    ``ranks`` order the LoDs unless the margins bring a sequence; those without a rank (negative)
    and those that the sequence does not name are left out.
    """
    ranks = margins.order(ranks)
    rating, draws = realism.expected()
    decisions = []
    for distance in dict.fromkeys(cell[0] for cell in realism.cells):
        own = [
            (i, lod)
            for i, (where, lod) in enumerate(realism.cells)
            if where == distance and ranks.get(lod, -1.0) >= 0
        ]
        own.sort(key=lambda item: -ranks[item[1]])
        if len(own) < 2:
            continue
        (top, best), *lower = own
        gaps = {lod: (rating[top] - rating[i], draws[:, top] - draws[:, i]) for i, lod in lower}
        decisions.append(_decide(distance, best, gaps, noticing, margins))
    return decisions


def _decide(
    distance: str,
    best: str,
    gaps: Mapping[str, tuple[float, Floats]],
    noticing: Noticing | None,
    margins: Margins,
) -> Decision:
    seen = {lod: excess_of(noticing, (distance, lod, best)) for lod in gaps}
    enough = {
        lod: (gap[1] < margins.realism_points) & _unnoticed(seen[lod], margins, len(gap[1]))
        for lod, gap in gaps.items()
    }
    shares = _cheapest_shares(enough)
    verdicts: list[Verdict] = []
    is_reached, chosen = True, best
    for lod, gap in gaps.items():
        noticed = seen[lod]
        verdict = Verdict(
            distance=distance,
            lod=lod,
            best=best,
            realism=against(*gap, margins.realism_points, confidence=margins.confidence),
            noticed=noticed
            and against(*noticed, margins.noticed_share, confidence=margins.confidence),
            is_reached=is_reached,
            share_cheapest=shares[lod],
        )
        verdicts.append(verdict)
        is_reached = is_reached and verdict.outcome == EQUIVALENT
        chosen = lod if is_reached else chosen
    rest = 1.0 - sum(shares.values())
    return Decision(distance, best, chosen, tuple(verdicts), max(rest, 0.0))


def against(value: float, draws: Floats, margin: float, *, confidence: float) -> Test:
    """Hold an estimate with its draws (n_draws,) against a margin."""
    low, high = np.quantile(draws, (1 - confidence, confidence))
    beyond, count = int((draws >= margin).sum()), len(draws)
    p_values = ((1 + n) / (1 + count) for n in (beyond, count - beyond))
    return Test(float(value), float(low), float(high), margin, *p_values)


def excess_of(noticing: Noticing | None, pair: tuple[str, str, str]) -> tuple[float, Floats] | None:
    """Return the share of yes beyond false alarms for a pair, with draws, where it was shown."""
    if noticing is None:
        return None
    distance, lod, best = pair
    named = [own for own in (pair, (distance, best, lod)) if own in noticing.pairs]
    if not named:
        return None
    place = noticing.pairs.index(named[0])
    (yes, yes_draws), (alarm, alarm_draws) = noticing.shares(), noticing.false_alarms()
    return float(yes[place] - alarm), yes_draws[:, place] - alarm_draws


def _unnoticed(
    seen: tuple[float, Floats] | None, margins: Margins, count: int
) -> NDArray[np.bool_]:
    return np.ones(count, dtype=bool) if seen is None else seen[1] < margins.noticed_share


def _cheapest_shares(enough: Mapping[str, NDArray[np.bool_]]) -> dict[str, float]:
    """Return for each LoD, from the highest down, the share of draws in which it is the cheapest.

    In each draw the sequence goes down as long as a LoD is enough.
    """
    names = list(enough)
    down = np.cumprod(np.array([enough[name] for name in names]), axis=0)
    after = np.vstack([down[1:], np.zeros_like(down[:1])])
    return dict(zip(names, (down - after).mean(axis=1).tolist(), strict=True))
