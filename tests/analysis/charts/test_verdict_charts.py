"""The decision chart and the contrasts: verdicts as they are, margins drawn, n stated."""

from collections.abc import Callable

import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from analysis.charts import CHARTS
from analysis.charts.decision import REFERENCE, decision_cells
from analysis.charts.forest import contrasts
from analysis.charts.material import Material
from analysis.charts.stability import stability_sentence, stability_table
from analysis.charts.style import INK
from analysis.decision.verdict_tables import verdict_table

Texts = Callable[[Figure], list[str]]


def test_cells_of_the_decision_chart_are_the_decisions(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    cells = decision_cells(material)
    assert cells.groupby("distance")["share_cheapest"].sum().tolist() == pytest.approx([1.0] * 3)
    said = texts_of(drawn_small["decision-chart"])
    assert {"ultra", "high", "low", "near\niris 160 px", "far\niris 12 px"} <= set(said)
    for row in cells.itertuples():
        assert f"{100 * row.share_cheapest:.0f}\N{NO-BREAK SPACE}%" in said
    prices = [text for text in said if text.endswith("ms")]
    assert sorted(prices)[-1].endswith("300\N{NO-BREAK SPACE}ms")
    assert len(prices) == 9
    assert sum(text.startswith(REFERENCE) for text in prices) == 3


def test_a_frame_marks_the_chosen_lod_of_each_distance(
    material: Material, drawn_small: dict[str, Figure]
) -> None:
    (axes,) = drawn_small["decision-chart"].axes
    framed = {
        round(patch.get_x() + patch.get_width() / 2)
        for patch in axes.patches
        if isinstance(patch, Rectangle) and patch.get_linewidth() > 2
    }
    assert framed == {0, 1, 2}
    assert decision_cells(material).groupby("distance")["chosen"].sum().tolist() == [1, 1, 1]


def test_contrasts_draw_the_verdicts_numbers_and_both_margins(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table, figure = contrasts(material), drawn_small["contrasts"]
    assert (table[["distance", "lod", "verdict", "realism_loss_high"]]).equals(
        verdict_table(list(material.inference.decisions))[
            ["distance", "lod", "verdict", "realism_loss_high"]
        ]
    )
    drawn = [line for line in figure.axes[0].lines if len(line.get_xdata()) == 2]
    ends = {tuple(line.get_xdata()) for line in drawn}
    wanted = set(zip(table["realism_loss_low"], table["realism_loss_high"], strict=True))
    assert wanted <= ends
    said = texts_of(figure)
    assert {"margin 0.50", "margin 25\N{NO-BREAK SPACE}%", "ultra − high"} <= set(said)
    counted = [text for text in said if "n\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}14" in text]
    assert len(counted) >= 4
    for axes, name in zip(figure.axes, ("realism_margin", "noticed_margin"), strict=True):
        dashes = [line for line in axes.lines if line.get_linestyle() == "--"]
        assert [line.get_xdata()[0] for line in dashes] == [table[name].iloc[0]]
        assert dashes[0].get_color() == INK


def test_cost_crosses_have_the_intervals_of_pareto_csv(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    points = material.inference.pareto
    assert len(points) == 9
    figure = drawn_small["realism-against-cost"]
    ends = {tuple(line.get_xdata()) for axes in figure.axes for line in axes.lines}
    assert {(point.ms[1], point.ms[2]) for point in points} <= ends
    said = texts_of(figure)
    assert "milliseconds per frame (2 eyes, 640x360 pixels, llvmpipe)" in said
    assert said.count("ultra") == 3


def test_without_costs_the_chart_says_what_to_give(material: Material, texts_of: Texts) -> None:
    chart = next(own for own in CHARTS if own.name == "realism-against-cost")
    said = [" ".join(text.split()) for text in texts_of(chart.draw(Material(material.tables)))]
    assert any("give the file that ocularist bench writes (--bench)" in text for text in said)


def test_the_decision_says_which_verdicts_hang_on_one_person(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    alone = material.left_out
    told = stability_sentence(material)
    said = " ".join(" ".join(texts_of(drawn_small["decision-chart"])).split())
    assert told in said
    moved = alone[alone["is_moved"]]
    for (distance, lod), own in moved.groupby(["distance", "lod"]):
        assert f"{lod} at {distance} ({len(own)} of 14)" in told
    still = Material(material.tables, None, material.inference)
    still.__dict__["left_out"] = alone.assign(is_moved=False)
    assert stability_sentence(still) == "Leaving out any one of the 14 people changes no verdict."


def test_who_moves_a_verdict_has_a_row(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table = stability_table(material)
    assert set(table["people"]) >= {f"without S{i:03d}" for i in range(1, 15)}
    alone = material.left_out
    moving = {f"without {who}" for who in alone.loc[alone["is_moved"], "people"]}
    said = texts_of(drawn_small["verdict-stability"])
    assert {text for text in said if text.startswith("without S")} == moving
    stays = (~alone["is_moved"]).groupby([alone["distance"], alone["lod"]]).sum()
    assert "stays without, of 14" in said
    assert sorted(text for text in said if text.isdigit()) == sorted(map(str, stays))
