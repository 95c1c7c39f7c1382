"""How much people differ, with intervals that follow the likelihood."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.estimates import person_effects as module
from analysis.estimates.person_effects import COLUMNS, person_effects
from analysis.estimates.realism import realism_of
from analysis.tables.reading import Tables


def test_the_thesiss_people_differ_in_leniency(
    thesis_tables: Tables, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitted = realism_of(thesis_tables.ratings, np.random.default_rng(1), scale=(1, 5))
    table = person_effects(fitted)
    assert tuple(table.columns) == COLUMNS
    (row,) = table.to_dict("records")
    assert row["effect"] == "leniency"
    assert 0 < row["spread_low"] < row["spread"] == fitted.fit.sd("leniency") < row["spread_high"]
    assert row["interval"] == "profile likelihood"
    monkeypatch.setattr(module, "_MANY", 5)
    wald = person_effects(fitted).to_dict("records")[0]
    assert wald["interval"] == "standard error"
    assert wald["spread_high"] == pytest.approx(row["spread_high"], rel=0.2)
    assert wald["spread_high"] != row["spread_high"]
