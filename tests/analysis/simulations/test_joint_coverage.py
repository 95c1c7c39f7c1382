"""The joint scale of ratings and comparisons on simulated people: its intervals hold the truth."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from analysis.estimates.joint import joint_of
from analysis.power.replicates import answers_of
from analysis.power.tables import as_tables
from analysis.tables.columns import STANDARD_LODS

sys.path += [str(Path(__file__).parent), str(Path(__file__).parents[1])]
from chance import least
from repeated import BEST, DISTANCES, Setting, setting

LONG = pytest.mark.long


def losses(own: Setting, seed: int) -> dict[tuple[str, str], tuple[float, float, float]]:
    """Return the loss of each LoD in one study, with its 95 % interval."""
    rng = np.random.default_rng([12, seed])
    answers = answers_of(own.plan, own.truth, rng)
    seen = np.ones(len(own.plan.person), dtype=bool)
    joint = joint_of(
        own.prepared.realism_of(answers, seen, rng), as_tables(own.plan, answers).comparisons, rng
    )
    assert joint is not None
    table = joint.table(dict.fromkeys(DISTANCES, BEST)).dropna(subset="loss")
    cells = zip(table["distance"], table["lod"], strict=True)
    numbers = table[["loss", "loss_low", "loss_high"]].to_numpy()
    return {cell: tuple(row) for cell, row in zip(cells, numbers.tolist(), strict=True)}


@pytest.mark.parametrize(
    ("people", "studies", "truth"),
    [
        (24, 4, "thesis"),
        *(pytest.param(n, 150, t, marks=LONG) for n in (10, 24) for t in ("thesis", "equal")),
        pytest.param(100, 40, "thesis", marks=LONG),
    ],
)
def test_intervals_of_the_joint_scale_hold_the_loss(people: int, studies: int, truth: str) -> None:
    own = setting(people, truth)
    found = [losses(own, seed) for seed in range(studies)]
    holds = {
        cell: [low <= own.truth.loss(*cell, best=BEST) <= high for _, low, high in rows]
        for cell in ((d, lod) for d in DISTANCES for lod in STANDARD_LODS[:-1])
        if (rows := [study[cell] for study in found])
    }
    shares = {cell: float(np.mean(own)) for cell, own in holds.items()}
    each = np.array(list(holds.values()), dtype=float).mean(axis=0)
    error = float(each.std() / np.sqrt(studies))
    print(f"{people} {truth}: {100 * each.mean():.1f} +- {100 * error:.1f} %", shares)
    assert each.mean() >= least(studies, 0.93), shares
    assert min(shares.values()) >= least(studies, 0.89), shares
