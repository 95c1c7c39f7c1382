"""Bias and inconsistency: agreement with sureal, recovery, and no runaway weight."""

from __future__ import annotations

import contextlib
import io
from types import SimpleNamespace

import numpy as np
import pytest
from sureal import P910AnnexEModel
from sureal.dataset_reader import RawDatasetReader

from analysis.screening.annex_e import bias_and_inconsistency
from analysis.screening.bt500 import is_rejected
from analysis.screening.presented import Presented


def shown(table: np.ndarray) -> Presented:
    """Take a table of ratings (n_stimuli, n_people), nan where missing, as its rows."""
    stimulus, person = np.nonzero(np.isfinite(table))
    names = tuple(f"P{i}" for i in range(table.shape[1]))
    return Presented(names, person, stimulus, stimulus, table[stimulus, person])


def ratings(rng: np.random.Generator, scatter: np.ndarray, stimuli: int) -> np.ndarray:
    people = len(scatter)
    quality = rng.uniform(1.5, 4.5, (stimuli, 1))
    noise = rng.normal(0, 1, (stimuli, people)) * scatter
    return np.asarray(quality + np.linspace(-0.5, 0.5, people) + noise)


def test_the_annexes_own_estimates_agree_with_sureal(rng: np.random.Generator) -> None:
    table = np.clip(np.round(ratings(rng, np.linspace(0.4, 1.2, 9), 40)), 1, 5)
    clips = [
        {"content_id": 0, "asset_id": j, "os": list(row), "path": str(j)}
        for j, row in enumerate(table)
    ]
    dataset = SimpleNamespace(
        dataset_name="d",
        ref_videos=[{"content_id": 0, "content_name": "c", "path": "r"}],
        dis_videos=clips,
        ref_score=5,
    )
    with contextlib.redirect_stdout(io.StringIO()):
        theirs = P910AnnexEModel(RawDatasetReader(dataset)).run_modeling(normalize_final=False)
    ours = bias_and_inconsistency(shown(table), floor=0.0, prior=0.0, corrected=False)
    np.testing.assert_allclose(ours.quality, theirs["quality_scores"], atol=1e-6)
    np.testing.assert_allclose(ours.bias, theirs["observer_bias"], atol=1e-6)
    np.testing.assert_allclose(ours.inconsistency, theirs["observer_inconsistency"], atol=1e-6)


def test_bias_and_inconsistency_come_back_with_missing_ratings(rng: np.random.Generator) -> None:
    scatter = np.array([0.3, 0.5, 0.5, 0.6, 0.6, 0.7, 0.8, 1.5])
    table = ratings(rng, scatter, 300)
    table[rng.random(table.shape) < 0.3] = np.nan
    found = bias_and_inconsistency(shown(table))
    np.testing.assert_allclose(found.bias, np.linspace(-0.5, 0.5, 8), atol=0.15)
    np.testing.assert_allclose(found.inconsistency, scatter, rtol=0.2)
    assert found.bias.sum() == pytest.approx(0.0)


def test_nobody_takes_all_weight_by_chance() -> None:
    table = np.round(ratings(np.random.default_rng(3), np.full(5, 0.8), 6))
    bare = bias_and_inconsistency(shown(table), floor=0.0, prior=0.0, corrected=False).inconsistency
    guarded = bias_and_inconsistency(shown(table)).inconsistency
    assert bare.min() < 0.01  # one person's ratings are fitted exactly
    assert guarded.min() > 0.3
    assert bias_and_inconsistency(shown(table), floor=0.5).inconsistency.min() >= 0.5


def test_bt500_rejects_who_strays_on_both_sides_and_keeps_who_is_strict(
    rng: np.random.Generator,
) -> None:
    table = 3 + rng.normal(0, 0.5, (40, 30))
    table[:, 0] = 3 + 1.3 * (-1.0) ** np.arange(40)
    table[:, 1] = 3 - 1.3
    rejected = is_rejected(shown(table))
    assert rejected[0]
    assert not rejected[1:].any()


def test_stimuli_that_all_rate_alike_reject_nobody() -> None:
    assert not is_rejected(shown(np.full((5, 4), 3.0))).any()
