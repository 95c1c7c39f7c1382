"""Print how often intervals hold the truth and verdicts fall: what stands in docs/power.md.

Not a test. Run with the number of people, of studies and the truth: ``24 200 thesis --tables``.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path += [str(Path(__file__).parent), str(Path(__file__).parents[3])]

from repeated import (
    by_kind,
    held,
    model_intervals,
    setting,
    table_intervals,
    table_truths,
    threshold_intervals,
)

from analysis.decision.margins import DEFAULT
from analysis.power.replicates import answers_of


def report(people: int, studies: int, truth: str, *, with_tables: bool) -> Iterator[str]:
    """Yield a line for each kind of interval: how often it holds the truth."""
    own = setting(people, truth)
    models, tables = [], []
    true: dict[str, float] = {}
    outcomes: dict[tuple[str, str], int] = defaultdict(int)
    for number in range(studies):
        rng = np.random.default_rng([people, number])
        found, true = model_intervals(own, rng)
        models.append(found)
        if with_tables:
            tables.append(table_intervals(own, rng))
        answers = answers_of(own.plan, own.truth, rng)
        for distance, lod, verdict in own.prepared.decide(answers, rng, margins=DEFAULT).verdicts():
            outcomes[f"{distance} {lod}", verdict] += 1
    told = held(models, true)
    if truth == "equal":
        told |= held(models, {name: 0.0 for name in models[0] if name.startswith("d'")})
    if tables:
        told |= held(tables, table_truths(own))
    for name, (share, error, count) in by_kind(told).items():
        yield f"{truth} n={people} {name}: {100 * share:.1f} % (+- {100 * error:.1f}) of {count}"
    worst = sorted((np.mean(v), k) for k, v in told.items())[:4]
    yield f"   least: {', '.join(f'{k} {100 * s:.1f}' for s, k in worst)}"
    for (name, verdict), count in sorted(outcomes.items()):
        yield f"   {name}: {verdict} {100 * count / studies:.1f} %"


def report_thresholds(people: int, studies: int) -> Iterator[str]:
    """Yield how often intervals of the sizes from which a LoD is noticed hold the true one."""
    made = [threshold_intervals(people, np.random.default_rng([5, i])) for i in range(studies)]
    for name, own in held([found for found, _ in made], made[0][1]).items():
        yield f"n={people} {name}: {100 * np.mean(own):.1f} % of {len(own)}"


if __name__ == "__main__":
    PEOPLE, STUDIES, TRUTH = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    if TRUTH == "thresholds":
        LINES = report_thresholds(PEOPLE, STUDIES)
    else:
        LINES = report(PEOPLE, STUDIES, TRUTH, with_tables="--tables" in sys.argv)
    for line in LINES:
        print(line, flush=True)
