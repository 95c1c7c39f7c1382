"""FLIP of equal, nearly equal and opposite pictures."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest

from renderer.encoding.flip import flip_map, is_installed

GREY = np.full((24, 32, 3), 120, np.uint8)


def test_equal_pictures_have_none_and_opposite_ones_all_of_it() -> None:
    assert flip_map(GREY, GREY).max() == 0.0
    assert flip_map(np.zeros_like(GREY), np.full_like(GREY, 255)).mean() > 0.9


def test_one_step_of_255_everywhere_is_seen_as_a_few_hundredths() -> None:
    found = flip_map(GREY, GREY + 1)
    assert found.shape == (24, 32)
    assert 0.005 < found.mean() < 0.05


def test_a_missing_package_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    assert is_installed()
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    assert not is_installed()
