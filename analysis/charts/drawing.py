"""Draw all charts into the bytes of their files."""

from __future__ import annotations

from analysis.charts.catalogue import CHARTS
from analysis.charts.material import Material
from analysis.charts.style import figure_bytes


def draw_charts(material: Material) -> dict[str, bytes]:
    """Return every chart as SVG and PNG by file name; one figure serves both."""
    files: dict[str, bytes] = {}
    for chart in CHARTS:
        figure = chart.draw(material)
        files |= {f"{chart.name}.{kind}": figure_bytes(figure, kind) for kind in ("svg", "png")}
    return files
