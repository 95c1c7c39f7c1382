"""The charts, which the report and the dashboard draw from one catalogue.

Only this package loads a plotting library, and nothing else of the analysis imports it but the
report.
"""

from analysis.charts.catalogue import CHARTS, Chart, figures
from analysis.charts.style import figure_bytes

__all__ = ["CHARTS", "Chart", "figure_bytes", "figures"]
