"""A chart's title and the mark of simulated data stand apart, however narrow the chart."""

from __future__ import annotations

import pytest

from analysis.charts.style import SIMULATED, figure_bytes, new_figure

TITLE = "Which LoD is enough, and how sure that is"


@pytest.mark.parametrize(("width_in", "lines"), [(3.2, 2), (4.2, 2), (7.0, 1)])
def test_a_title_breaks_where_it_would_run_into_the_mark(width_in: float, lines: int) -> None:
    figure = new_figure(width_in, 3.0, TITLE, is_simulated=True)
    figure.canvas.draw()
    heading = next(text for text in figure.texts if text.get_text().split() == TITLE.split())
    assert len(heading.get_text().splitlines()) == lines
    mark = next(text for text in figure.texts if text.get_text() == SIMULATED)
    assert not heading.get_window_extent().overlaps(mark.get_window_extent())


def test_a_title_of_real_data_stays_whole() -> None:
    figure = new_figure(4.2, 3.0, TITLE, is_simulated=False)
    assert figure.get_suptitle() == TITLE


@pytest.mark.parametrize("kind", ["svg", "png"])
def test_a_dollar_sign_in_a_name_begins_no_formula(kind: str) -> None:
    figure = new_figure(4.2, 3.0, "cheap$\\frac{ and dear$", is_simulated=False)
    axes = figure.add_subplot()
    axes.set_yticks([0, 1], labels=["$a_b", "c$\\sqrt{"])
    axes.set_xlabel("$\\frac{$")
    axes.plot([0, 1], [0, 1], label="$^$")
    axes.legend()
    assert len(figure_bytes(figure, kind)) > 1000
