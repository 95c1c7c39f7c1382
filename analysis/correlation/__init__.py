"""Does perceived realism follow the actual LoD? Rank correlation that respects repeated measures.

Pooling all ratings would treat one person's answers as independent people. So: Kendall's tau-b
within each person, averaged on Fisher's z scale over people; beside it Somers' d, which counts a
tie as no preference, and the repeated-measures correlation (parallel lines, one per person).
"""

from analysis.correlation.averages import mean_tau, repeated_measures_correlation, tau_p
from analysis.correlation.concordance import Concordance, count_pairs
from analysis.correlation.per_distance import ALL_DISTANCES, person_concordance, rank_correlations

__all__ = [
    "ALL_DISTANCES",
    "Concordance",
    "count_pairs",
    "mean_tau",
    "person_concordance",
    "rank_correlations",
    "repeated_measures_correlation",
    "tau_p",
]
