"""Links: accurate where probabilities can no longer be subtracted."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from analysis.models.links import LINKS, LOGIT, PROBIT, Link

LAWS = {"probit": stats.norm, "logit": stats.logistic}


@pytest.mark.parametrize("name", list(LINKS))
def test_cdf_pdf_quantile_and_sd_are_the_laws(name: str) -> None:
    link, law = LINKS[name], LAWS[name]
    x = np.linspace(-6, 6, 25)
    assert link.cdf(x) == pytest.approx(law.cdf(x), rel=1e-12)
    assert link.log_cdf(x) == pytest.approx(law.logcdf(x), rel=1e-12)
    assert link.log_pdf(x) == pytest.approx(law.logpdf(x), rel=1e-12)
    assert link.quantile(link.cdf(x)) == pytest.approx(x, rel=1e-7, abs=1e-7)
    assert link.sd == pytest.approx(law.std())


@pytest.mark.parametrize("link", [PROBIT, LOGIT])
def test_an_interval_is_as_likely_as_its_mirror_image(link: Link) -> None:
    low, high = np.array([-3.0, 0.2, 7.0, -1.0]), np.array([-2.0, 0.3, 7.5, np.inf])
    assert link.log_interval(low, high) == pytest.approx(link.log_interval(-high, -low))


def test_far_intervals_keep_their_logarithm() -> None:
    # 1 - Phi(x) = phi(x)/x (1 - 1/x^2 + 3/x^4 - ...), and [40, 41] holds all but e^-40.5 of it.
    x = 40.0
    tail = -x * x / 2 - 0.5 * math.log(2 * math.pi) - math.log(x)
    tail += math.log(1 - x**-2 + 3 * x**-4 - 15 * x**-6)
    for low, high in ((40.0, 41.0), (-41.0, -40.0)):
        found = PROBIT.log_interval(np.array([low]), np.array([high]))
        assert found[0] == pytest.approx(tail, abs=1e-9)
    logit = LOGIT.log_interval(np.array([800.0]), np.array([801.0]))
    assert logit[0] == pytest.approx(-800 + math.log(1 - math.exp(-1)), abs=1e-9)


def test_all_of_the_line_is_certain() -> None:
    for link in (PROBIT, LOGIT):
        assert link.log_interval(np.array([-np.inf]), np.array([np.inf])) == pytest.approx(0.0)
