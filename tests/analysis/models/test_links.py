"""Links: accurate where probabilities can no longer be subtracted."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from analysis.models.links import LOGIT, PROBIT, Link

LAWS = {"probit": stats.norm, "logit": stats.logistic}


@pytest.mark.parametrize("link", [PROBIT, LOGIT])
def test_cdf_pdf_quantile_and_sd_are_the_laws(link: Link) -> None:
    law = LAWS[link.name]
    x = np.linspace(-6, 6, 25)
    assert link.cdf(x) == pytest.approx(law.cdf(x), rel=1e-12)
    assert link.log_cdf(x) == pytest.approx(law.logcdf(x), rel=1e-12)
    assert link.log_pdf(x) == pytest.approx(law.logpdf(x), rel=1e-12)
    assert link.quantile(link.cdf(x)) == pytest.approx(x, rel=1e-7, abs=1e-7)
    assert link.sd == pytest.approx(law.std())


def intervals(link: Link, *bounds: float) -> np.ndarray:
    return link.log_intervals(np.array(bounds)[None, :, None])[0, :, 0]


@pytest.mark.parametrize("link", [PROBIT, LOGIT])
def test_intervals_are_differences_and_as_likely_as_their_mirror_images(link: Link) -> None:
    bounds = (-3.0, -1.0, 0.2, 4.0)
    shares = np.diff([0.0, *LAWS[link.name].cdf(bounds), 1.0])
    assert np.exp(intervals(link, *bounds)) == pytest.approx(shares, rel=1e-12)
    mirrored = intervals(link, *(-b for b in reversed(bounds)))
    assert intervals(link, *bounds) == pytest.approx(mirrored[::-1], rel=1e-13)


def test_far_intervals_keep_their_logarithm() -> None:
    # 1 - Phi(x) = phi(x)/x (1 - 1/x^2 + 3/x^4 - ...), and [40, 41] holds all but e^-40.5 of it.
    x = 40.0
    tail = -x * x / 2 - 0.5 * math.log(2 * math.pi) - math.log(x)
    tail += math.log(1 - x**-2 + 3 * x**-4 - 15 * x**-6)
    assert intervals(PROBIT, 40.0, 41.0)[1] == pytest.approx(tail, abs=1e-9)
    assert intervals(PROBIT, -41.0, -40.0)[1] == pytest.approx(tail, abs=1e-9)
    assert intervals(PROBIT, 40.0)[1] == pytest.approx(tail, abs=1e-9)
    far = intervals(LOGIT, 800.0, 801.0)[1]
    assert far == pytest.approx(-800 + math.log(1 - math.exp(-1)), abs=1e-9)
