"""What the analysis's tests share: the thesis's seven pairings and simulated answers to them."""

import numpy as np
import pytest

from analysis.observers import Stimulus
from analysis.population import POPULATION

THESIS = (
    ("macroscopic", "medium", "low"),
    ("macroscopic", "high", "ultra"),
    ("macroscopic", "high", "medium"),
    ("near", "low", "ultra"),
    ("near", "low", "medium"),
    ("near", "ultra", "low"),
    ("far", "ultra", "low"),
)


@pytest.fixture
def thesis_stimuli() -> list[Stimulus]:
    """Return the seven clips of the thesis's Table 5.2."""
    return [
        Stimulus(distance, POPULATION.iris_px[distance], left, right)
        for distance, left, right in THESIS
    ]


@pytest.fixture
def rng() -> np.random.Generator:
    """Return a generator with a seed of its own in every test."""
    return np.random.default_rng(20120831)
