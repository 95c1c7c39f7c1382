"""Scales, curves and people: what is drawn is what stands in the table, and what it rests on."""

from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.figure import Figure

from analysis.charts import CHARTS
from analysis.charts.course import course_table
from analysis.charts.curves import curves_table
from analysis.charts.detection import detection_table
from analysis.charts.heat import heat_table
from analysis.charts.material import Material
from analysis.charts.people import observers_table
from analysis.charts.scales import latent_table, preference_table
from analysis.charts.spread import spread_table
from analysis.charts.style import PAGE_WIDTH_IN, SIMULATED
from analysis.curves.curve import NOTICED

Texts = Callable[[Figure], list[str]]


def spans(figure: Figure, panel: int) -> set[tuple[float, float]]:
    lines = [line.get_xdata() for line in figure.axes[panel].lines]
    return {(float(x[0]), float(x[1])) for x in lines if len(x) == 2}


@pytest.mark.parametrize("chart", CHARTS, ids=lambda chart: chart.name)
def test_every_chart_fits_a_page_is_labelled_and_has_a_table(
    chart: object, material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    own = next(c for c in CHARTS if c is chart)
    figure = drawn_small[own.name]
    width, height = figure.get_size_inches()
    assert width <= PAGE_WIDTH_IN
    assert height <= 9.5
    assert SIMULATED in texts_of(figure)
    assert own.title in texts_of(figure)
    assert len(own.table(material)) or any("yet" in text for text in texts_of(figure))
    assert own.caption.endswith((".", ".)"))


def test_latent_realism_draws_both_scales_and_the_plain_means(
    material: Material, drawn_small: dict[str, Figure]
) -> None:
    table, figure = latent_table(material), drawn_small["latent-realism"]
    free = table.iloc[1:]
    assert set(zip(free["latent_low"], free["latent_high"], strict=True)) <= spans(figure, 0)
    assert set(zip(table["rating_low"], table["rating_high"], strict=True)) <= spans(figure, 1)
    known = table[np.isfinite(table["mean_low"])]
    assert set(zip(known["mean_low"], known["mean_high"], strict=True)) <= spans(figure, 1)


def test_scales_that_nothing_links_start_at_their_own_highest_lod(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table = preference_table(material)
    assert table["scale"].tolist() == [1, 1, 1, 2, 2, 2, 3, 3, 3]
    assert table.loc[table["jod"] == 0, "lod"].tolist() == ["ultra"] * 3
    assert table["step_low"].isna().sum() == 3
    (axes,) = drawn_small["preference"].axes
    said = texts_of(drawn_small["preference"])
    assert [label.get_text() for label in axes.get_yticklabels()].count("ultra = 0") == 3
    assert any("comparisons" in text and "JOD" in text for text in said)


def test_detection_states_false_alarms_and_how_many_answers_they_rest_on(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table, figure = detection_table(material), drawn_small["detection"]
    assert set(zip(table["d_prime_low"], table["d_prime_high"], strict=True)) <= spans(figure, 0)
    first = table.iloc[0]
    share = f"{100 * first['false_alarms']:.0f}\N{NO-BREAK SPACE}%"
    assert f"false alarms {share}, {first['catch_answers']} answers" in texts_of(figure)


def test_without_equal_pairs_there_is_no_sensitivity(
    thesis_tables: object, texts_of: Texts
) -> None:
    chart = next(own for own in CHARTS if own.name == "detection")
    said = texts_of(chart.draw(Material(thesis_tables)))
    assert any("No pair of equal LoDs has been answered" in text for text in said)


def test_curves_run_over_the_sizes_shown_and_no_further(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table, figure = curves_table(material, NOTICED), drawn_small["noticed-by-size"]
    assert set(table["lod"]) == {"low", "high"}
    lines = [line for line in figure.axes[0].lines if len(line.get_xdata()) > 10]
    for line, (_, own) in zip(lines, table.groupby("lod", sort=False), strict=True):
        assert np.array_equal(line.get_xdata(), own["size"])
        assert np.array_equal(line.get_ydata(), own["value"])
    low, high = figure.axes[0].get_xlim()
    assert low > 12 / 1.3
    assert high < 160 * 1.3
    said = texts_of(figure)
    assert {
        "near",
        "medium",
        "far",
        "diameter of the iris, pixels",
    } <= set(said)
    assert any(text.startswith("false alarms") for text in said)
    curves = [own for own in material.inference.curves.curves if own.kind == "noticed"]
    for curve in curves:  # each beside its threshold with the interval
        size, interval = curve.say(curve.threshold("margin")).split(" (")
        name = f"{curve.lod}, n\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}14"
        assert f"{name}\nmargin: {size}\n({interval}" in said


def test_flagged_people_are_named_and_everybody_is_counted(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table = observers_table(material)
    assert "S001" in table.loc[table["flags"] != "", "participant"].tolist()
    count = int((table["flags"] != "").sum())
    said = texts_of(drawn_small["observers"])
    assert "S001: straight-liner" in said
    light = int(((table["weight"] < 0.8) & (table["flags"] == "")).sum())
    assert sum("inconsistent or seems not to have looked" in text for text in said) == (light > 0)
    assert f"flagged, n\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}{count}" in said


def test_the_models_shrunken_estimates_stand_below_the_answers(
    material: Material, drawn_small: dict[str, Figure]
) -> None:
    table = observers_table(material)
    assert table["model_leniency"].notna().all()
    assert table["model_style"].isna().all()  # 18 ratings per person do not tell it
    answers, leniency = drawn_small["observers"].axes
    assert "above 0: lenient" in leniency.get_title()
    shown = np.concatenate([line.get_ydata() for line in leniency.lines[:2]])
    assert sorted(shown) == pytest.approx(sorted(table["model_leniency"]))
    assert "bias" in answers.get_xlabel()


def test_the_heat_map_holds_every_persons_ratings(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table = heat_table(material)
    (image,) = drawn_small["ratings-per-person"].axes[0].images
    shown = np.asarray(image.get_array())
    assert shown.shape == (14, 18)  # nine clips of two eyes
    assert "near-ultra-low, right: low" in texts_of(drawn_small["ratings-per-person"])
    assert np.nansum(shown) == pytest.approx(table["rating"].sum())


def test_the_course_of_a_session_is_flat_within_people_on_average(material: Material) -> None:
    table = course_table(material)
    assert table["first"].tolist() == list(range(1, 10))
    weighted = (table["change"] * table["people"]).sum() / table["people"].sum()
    assert weighted == pytest.approx(0, abs=0.02)


def test_spread_follows_the_curve_of_a_bounded_scale(material: Material) -> None:
    table = spread_table(material)
    m, a = table["mean"], table["a"].iloc[0]
    residual = table["variance"] - a * (m - 1) * (5 - m)
    assert 0 < a < 0.5
    assert float((residual * (m - 1) * (5 - m)).sum()) == pytest.approx(0, abs=1e-9)
