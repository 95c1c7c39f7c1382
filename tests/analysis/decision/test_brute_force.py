"""Verdicts, shares and fronts beside plain loops over draws that share no code with them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
import pytest

from analysis.costs.cost import COLUMNS, Costs
from analysis.costs.savings import cost_draws
from analysis.decision.margins import Margins
from analysis.decision.pareto import pareto
from analysis.decision.verdicts import decide
from analysis.models.draws import DRAWS

LODS = ("a", "b", "c", "d", "e", "plain")
MARGINS = Margins(realism_points=0.4, noticed_share=0.2, confidence=0.9)
Cell = tuple[str, str]
Pair = tuple[str, str, str]


@dataclass
class Rated:
    """Stands for Realism."""

    cells: tuple[Cell, ...]
    draws: np.ndarray

    def expected(self) -> tuple[np.ndarray, np.ndarray]:
        return np.median(self.draws, axis=0), self.draws


@dataclass
class Seen:
    """Stands for Noticing."""

    pairs: tuple[Pair, ...]
    yes: np.ndarray
    alarms: np.ndarray

    def shares(self) -> tuple[np.ndarray, np.ndarray]:
        return np.median(self.yes, axis=0), self.yes

    def false_alarms(self) -> tuple[float, np.ndarray]:
        return float(np.median(self.alarms)), self.alarms


def study(seed: int, draws: int) -> tuple[Rated, Seen, dict[str, float]]:
    rng = np.random.default_rng(seed)
    cells = tuple((d, lod) for d in ("near", "far", "alone") for lod in LODS if rng.random() < 0.8)
    places = rng.normal(3.0, 0.3, len(cells))
    rated = Rated(cells, places + rng.normal(0, 0.12, (draws, len(cells))))
    named = [(d, one, other) for d, one in cells for other in LODS if one != other]
    pairs = tuple(pair for pair in named if rng.random() < 0.6)
    yes = rng.uniform(0.05, 0.3, len(pairs)) + rng.normal(0, 0.03, (draws, len(pairs)))
    seen = Seen(pairs, yes, 0.1 + rng.normal(0, 0.01, draws))
    order = rng.permutation(5)
    return rated, seen, {lod: float(order[i]) for i, lod in enumerate(LODS[:5])} | {"plain": -1.0}


def excess(seen: Seen, distance: str, lod: str, best: str) -> list[float] | None:
    for pair in ((distance, lod, best), (distance, best, lod)):
        if pair in seen.pairs:
            own = seen.yes[:, seen.pairs.index(pair)]
            return [float(y - alarm) for y, alarm in zip(own, seen.alarms, strict=True)]
    return None


def quantile(values: list[float], share: float) -> float:
    """Return it between the two values of either side, as numpy and R's type 7 do."""
    own = sorted(values)
    place = share * (len(own) - 1)
    low = int(place)
    high = min(low + 1, len(own) - 1)
    return own[low] + (place - low) * (own[high] - own[low])


def verdict(loss: list[float], noticed: list[float] | None, *, is_reached: bool) -> str:
    held = [(loss, 0.4)] + ([(noticed, 0.2)] if noticed is not None else [])
    if any(quantile(values, 0.1) > margin for values, margin in held):
        return "different"
    is_shown = all(quantile(values, 0.9) < margin for values, margin in held)
    return "equivalent" if is_shown and noticed is not None and is_reached else "not shown"


@pytest.mark.parametrize("seed", range(12))
def test_the_sequence_is_that_of_plain_loops(seed: int) -> None:
    rated, seen, ranks = study(seed, 151)
    found = {own.distance: own for own in decide(rated, seen, ranks, margins=MARGINS)}
    for distance in ("near", "far", "alone"):
        shown = [lod for where, lod in rated.cells if where == distance and lod != "plain"]
        shown.sort(key=lambda lod: ranks[lod], reverse=True)
        if len(shown) < 2:
            assert distance not in found
            continue
        best, *lower = shown
        draws = {lod: rated.draws[:, rated.cells.index((distance, lod))] for lod in shown}
        told, chosen, is_reached = {}, best, True
        losses = {lod: [float(x) for x in draws[best] - draws[lod]] for lod in lower}
        noticed = {lod: excess(seen, distance, lod, best) for lod in lower}
        for lod in lower:
            told[lod] = verdict(losses[lod], noticed[lod], is_reached=is_reached)
            is_reached = is_reached and told[lod] == "equivalent"
            chosen = lod if is_reached else chosen
        cheapest = dict.fromkeys(shown, 0)
        for draw in range(151):
            last = best
            for lod in lower:
                own = noticed[lod]
                if losses[lod][draw] >= 0.4 or (own is not None and own[draw] >= 0.2):
                    break
                last = lod
            cheapest[last] += 1
        own_decision = found[distance]
        assert {own.lod: own.outcome for own in own_decision.verdicts} == told
        assert (own_decision.best, own_decision.lod) == (best, chosen)
        shares = {own.lod: own.share_cheapest for own in own_decision.verdicts}
        shares[best] = own_decision.best_share
        assert shares == pytest.approx({lod: n / 151 for lod, n in cheapest.items()})


def test_the_loops_meet_every_verdict() -> None:
    """Else the test above would say little."""
    met = {
        own.outcome
        for seed in range(12)
        for decision in decide(*study(seed, 151), margins=MARGINS)
        for own in decision.verdicts
    }
    assert met == {"equivalent", "different", "not shown"}


def test_the_front_is_that_of_plain_loops() -> None:
    rng = np.random.default_rng(4)
    places = np.array([2.6, 3.0, 2.9, 3.1])
    rated = Rated(
        tuple(("near", lod) for lod in LODS[:4]), places + rng.normal(0, 0.15, (DRAWS, 4))
    )
    rows = [
        ("gl", "1920x1080", 2, "near", 160.0, lod, ms, 0.3, 9)
        for lod, ms in zip(LODS[:4], (1.0, 1.3, 1.2, 1.25), strict=True)
    ]
    costs = Costs(pd.DataFrame(rows, columns=list(COLUMNS)), "gl", 2.0)
    times = [cost_draws(costs, "near", lod) for lod in LODS[:4]]
    beaten = [[0] * 4 for _ in range(4)]
    fallen = [0] * 4
    for draw in range(DRAWS):
        at = [
            (float(ms[draw]), float(rated.draws[draw, i]))
            for i, ms in enumerate(times)
            if ms is not None
        ]
        for i, (ms, real) in enumerate(at):
            over = [
                k for k, (m, r) in enumerate(at) if m <= ms and r >= real and (m, r) != (ms, real)
            ]
            fallen[i] += bool(over)
            for k in over:
                beaten[i][k] += 1
    found = pareto(rated, costs)
    assert [own.share_dominated for own in found] == pytest.approx([n / DRAWS for n in fallen])
    for i, own in enumerate(found):
        most = max(range(4), key=lambda k: beaten[i][k])
        assert own.dominated_by == (LODS[most] if beaten[i][most] else "")
        assert own.share_dominated_by == pytest.approx(beaten[i][most] / DRAWS)
    assert min(fallen) > 0
