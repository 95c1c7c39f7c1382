"""Holm: as statsmodels has it, with missing values and refusals."""

from __future__ import annotations

import numpy as np
import pytest
from statsmodels.stats.multitest import multipletests

from analysis.estimates.multiplicity import holm


@pytest.mark.parametrize("seed", range(5))
def test_it_agrees_with_statsmodels(seed: int) -> None:
    p = np.random.default_rng(seed).beta(0.4, 1.5, 12)
    p[3] = p[7]
    np.testing.assert_allclose(holm(p), multipletests(p, method="holm")[1])


def test_a_case_by_hand() -> None:
    np.testing.assert_allclose(holm([0.01, 0.04, 0.03]), [0.03, 0.06, 0.06])


def test_missing_values_stay_missing_and_do_not_count() -> None:
    np.testing.assert_allclose(holm([0.02, np.nan, 0.5])[[0, 2]], holm([0.02, 0.5]))
    assert np.isnan(holm([0.02, np.nan, 0.5])[1])
    assert holm([]).shape == (0,)


def test_what_is_no_p_value_is_refused() -> None:
    with pytest.raises(ValueError, match=r"between 0 and 1; found 0\.1 to 1\.2"):
        holm([0.1, 1.2])
    with pytest.raises(ValueError, match=r"one row of numbers is accepted, found shape \(1, 2\)"):
        holm([[0.1, 0.2]])
