"""Bounds on counts of studies that chance alone crosses once in a thousand.

Not a test: what must hold is a share; how often it is met in a few studies is binomial.
"""

from __future__ import annotations

from scipy.stats import binom


def least(studies: int, share: float) -> float:
    """Return the share of studies below which one in a thousand falls by chance."""
    return float(binom.ppf(0.001, studies, share)) / studies


def most(studies: int, share: float) -> float:
    """Return the share of studies above which one in a thousand rises by chance."""
    return float(binom.ppf(0.999, studies, share)) / studies
