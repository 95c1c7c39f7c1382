"""Charts of the model's fit: residuals against the normal law, the scale's ends as predicted."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from scipy.special import ndtri
from scipy.stats import beta

from analysis.charts.ends import ends_table
from analysis.charts.material import Material
from analysis.charts.residuals import residual_quantiles

Texts = Callable[[Figure], list[str]]


def diagnosed(material: Material, residuals: np.ndarray) -> Material:
    table = pd.DataFrame({"residual": residuals})
    return Material(material.tables, None, material.inference, diagnosed=table)


def test_residuals_stand_in_order_within_the_band_of_their_rank(material: Material) -> None:
    n = 50
    exact = ndtri(np.arange(1, n + 1) / (n + 1))
    table = residual_quantiles(diagnosed(material, exact[::-1]))
    assert table["residual"].to_numpy() == pytest.approx(exact)
    assert table["is_within"].all()
    low = ndtri(beta.ppf(0.025, 7, n - 6))
    assert table.loc[6, "low"] == pytest.approx(low)
    far = residual_quantiles(diagnosed(material, 1.0 + exact))
    assert not far["is_within"].to_numpy()[10:40].any()


def test_of_many_residuals_the_ends_are_all_kept(material: Material) -> None:
    many = np.random.default_rng(1).standard_normal(5000)
    table = residual_quantiles(diagnosed(material, many))
    assert len(table) <= 400
    assert table["rank"].tolist()[:50] == list(range(1, 51))
    assert table["rank"].tolist()[-50:] == list(range(4951, 5001))
    assert table["is_within"].mean() > 0.9


def test_given_shares_lie_beside_the_models_ranges(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table, figure = ends_table(material), drawn_small["predicted-shares"]
    fives = table[(table["of"] == "cell") & (table["end"] == "highest")]
    points = {
        (float(line.get_xdata()[0]), line.get_color())
        for line in figure.axes[1].lines
        if len(line.get_xdata()) == 1
    }
    colours = np.where(fives["is_within"], "#0072B2", "#D55E00")
    assert points == set(zip(fives["share"], colours, strict=True))
    given = int(fives["count"].sum())
    assert any(f"{given} ratings of 5" in text for text in texts_of(figure))


def test_the_residuals_are_drawn_twice_with_how_many_there_are(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    figure, count = drawn_small["model-residuals"], len(material.residuals)
    assert f"quantile residual, sd ({count} ratings)" in texts_of(figure)
    whole, away = figure.axes
    drawn = np.concatenate([line.get_ydata() for line in whole.lines[1:]])
    assert np.sort(drawn) == pytest.approx(np.sort(material.residuals["residual"].to_numpy()))
    assert away.get_ylim()[0] == -away.get_ylim()[1]
