"""What the analysis's tests share: the thesis's seven clips and simulated answers to them."""

import numpy as np
import pandas as pd
import pytest

from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import Tables, tables_from

THESIS = (
    ("macroscopic", "medium", "low"),
    ("macroscopic", "high", "ultra"),
    ("macroscopic", "high", "medium"),
    ("near", "low", "ultra"),
    ("near", "low", "medium"),
    ("near", "ultra", "low"),
    ("far", "ultra", "low"),
)


@pytest.fixture(scope="session")
def thesis_clips() -> dict[str, Stimulus]:
    """Return the seven clips of the thesis's Table 5.2 by their number."""
    return {
        str(number): Stimulus(distance, POPULATION.iris_px[distance], left, right)
        for number, (distance, left, right) in enumerate(THESIS, start=1)
    }


@pytest.fixture(scope="session")
def thesis_frames(thesis_clips: dict[str, Stimulus]) -> dict[str, pd.DataFrame]:
    """Return a simulated thesis study, six experts and four others, as an export would write it."""
    return simulate_tables(
        thesis_clips,
        np.random.default_rng(1),
        participants=10,
        experts=[True] * 6 + [False] * 4,
    )


@pytest.fixture(scope="session")
def thesis_tables(thesis_frames: dict[str, pd.DataFrame]) -> Tables:
    """Return the same study as the analysis takes it."""
    return tables_from(thesis_frames, source="thesis/ratings.csv")


@pytest.fixture
def rng() -> np.random.Generator:
    """Return a generator with a seed of its own in every test."""
    return np.random.default_rng(20120831)
