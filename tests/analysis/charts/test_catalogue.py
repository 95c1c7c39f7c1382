"""Charts: what stands on them, and that odd data are told instead of drawn."""

import io
import threading

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

from analysis.charts import CHARTS, figures
from analysis.charts.material import Material
from analysis.charts.parts import distance_label
from analysis.charts.style import (
    LOD_COLOURS,
    SIMULATED,
    beeswarm,
    figure_bytes,
    lod_colour,
    scale_colours,
)
from analysis.simulation.observers import Stimulus
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import Tables, tables_from


def texts(figure: Figure) -> list[str]:
    return [text.get_text() for text in figure.findobj(Text) if text.get_text()]


@pytest.fixture(scope="module")
def drawn(thesis_tables: Tables) -> dict[str, Figure]:
    return figures(thesis_tables)


def test_every_chart_says_that_its_data_are_simulated(drawn: dict[str, Figure]) -> None:
    assert len(drawn) == len(CHARTS)
    for name, figure in drawn.items():
        assert SIMULATED in texts(figure), name


def test_no_chart_of_peoples_answers_says_simulated(thesis_frames: dict[str, pd.DataFrame]) -> None:
    real = tables_from(
        {name: frame.assign(simulated=False) for name, frame in thesis_frames.items()}
    )
    for figure in figures(real, ["realism-per-clip", "noticed-per-pair"]).values():
        assert not any("SIMULATED" in text for text in texts(figure))


def test_figure_five_two_names_clips_eyes_lods_distances_and_n(drawn: dict[str, Figure]) -> None:
    said = texts(drawn["realism-per-clip"])
    assert {"clip 1", "clip 7", "left medium", "right low"} <= set(said)
    assert {"macroscopic, iris 350 px", "near, iris 160 px", "far, iris 12 px"} <= set(said)
    counts = [text.removeprefix("n = ") for text in said if text.removeprefix("n = ").isdigit()]
    assert sum(count in ("9", "10") for count in counts) == 14
    assert sum(text.startswith("n = ") for text in said) == 3  # once per panel


def test_figure_five_two_draws_every_rating(
    drawn: dict[str, Figure], thesis_tables: Tables
) -> None:
    dots = sum(
        len(points.get_offsets())
        for axes in drawn["realism-per-clip"].axes
        for points in axes.collections
    )
    assert dots == thesis_tables.ratings["rating"].notna().sum()


def test_left_stands_left_of_right(drawn: dict[str, Figure]) -> None:
    for axes in drawn["realism-per-clip"].axes:
        eyes = [label.get_text().split()[0] for label in axes.get_xticklabels()]
        assert eyes == ["left", "right"] * (len(eyes) // 2)


def test_correlation_stands_on_its_panel(drawn: dict[str, Figure]) -> None:
    assert sum(text.startswith("τ = ") for text in texts(drawn["perceived-against-actual"])) == 3


def test_combinations_that_were_not_shown_say_so(drawn: dict[str, Figure]) -> None:
    assert texts(drawn["realism-matrix"]).count("not shown") == 3


def test_bars_of_shares_are_whole(drawn: dict[str, Figure]) -> None:
    for name in ("comparisons-per-clip", "comparisons-per-pair", "noticed-per-clip"):
        axes = drawn[name].axes[0]
        bars: dict[float, float] = {}
        for patch in axes.patches:
            y = round(patch.get_y(), 6)
            bars[y] = bars.get(y, 0.0) + patch.get_width()
        assert list(bars.values()) == pytest.approx([1.0] * len(bars)), name


def test_equal_figures_give_equal_bytes(thesis_tables: Tables) -> None:
    once, again = (figures(thesis_tables, ["realism-matrix"])["realism-matrix"] for _ in range(2))
    assert figure_bytes(once, "svg") == figure_bytes(again, "svg")


def test_a_picture_is_not_empty(drawn: dict[str, Figure]) -> None:
    png = Image.open(io.BytesIO(figure_bytes(drawn["realism-by-distance"], "png")))
    pixels = np.asarray(png.convert("RGB"))
    blue = tuple(int(LOD_COLOURS["ultra"][i : i + 2], 16) for i in (1, 3, 5))
    assert png.width > 800
    assert (pixels == blue).all(axis=-1).sum() > 100


@pytest.mark.parametrize("chart", CHARTS, ids=lambda chart: chart.name)
def test_an_empty_study_is_told_on_every_chart(chart: object) -> None:
    empty = tables_from(simulate_tables({}, np.random.default_rng(1), participants=0))
    figure = next(c for c in CHARTS if c is chart).draw(Material(empty))
    assert any("yet." in text for text in texts(figure))


def test_lods_without_rank_are_told_and_not_put_in_order() -> None:
    frame = pd.DataFrame(
        {"participant": ["A", "A", "B"], "lod": ["gloss", "matt", "matt"], "rating": [1, 2, 3]}
    )
    tables = tables_from({"ratings": frame})
    said = texts(figures(tables, ["perceived-against-actual"])["perceived-against-actual"])
    assert (
        "At no distance were two ranked LoDs rated, so there is no order to compare with." in said
    )


def test_irises_of_several_sizes_are_named_by_their_range() -> None:
    frame = pd.DataFrame({"participant": ["A", "B"], "lod": "low", "rating": [1, 2]})
    tables = tables_from({"ratings": frame.assign(distance="near", iris_px=[106.7, 160.0])})
    assert distance_label("near", tables) == "near, iris 107 to 160 px"
    assert distance_label("far", tables) == "far"


def test_more_clips_than_a_page_holds_are_told_by_pairing() -> None:
    pairs = [(a, b) for a in ("low", "high") for b in ("high", "ultra")]
    clips = {f"{a}-{b}-{i}": Stimulus("near", 160.0, a, b) for a, b in pairs for i in range(7)}
    tables = tables_from(simulate_tables(clips, np.random.default_rng(1), participants=2))
    by_name = {chart.name: chart for chart in CHARTS}
    table = by_name["comparisons-per-clip"].table(Material(tables))
    assert set(table["clip"]) == {f"{a} – {b}" for a, b in pairs}
    assert set(table["total"]) <= {13, 14}  # 7 clips, 2 people; an answer may be missing
    said = texts(figures(tables, ["realism-per-clip"])["realism-per-clip"])
    assert not any(text.startswith("low-high-") for text in said)


def test_many_clips_are_cut_into_rows() -> None:
    clips = {
        f"{number}": Stimulus("near", 160.0, left, right)
        for number, (left, right) in enumerate([("low", "ultra"), ("high", "medium")] * 8)
    }
    tables = tables_from(simulate_tables(clips, np.random.default_rng(1), participants=2))
    figure = figures(tables, ["realism-per-clip"])["realism-per-clip"]
    assert len([axes for axes in figure.axes if axes.get_visible()]) == 2
    assert "clip 15" in texts(figure)


def test_an_unknown_chart_is_refused_with_those_that_are(thesis_tables: Tables) -> None:
    with pytest.raises(ValueError, match='unknown chart "pie"; choose one of decision-chart, '):
        figures(thesis_tables, ["pie"])


def test_charts_can_be_drawn_in_threads(thesis_tables: Tables) -> None:
    """The dashboard does: no figure may depend on a current figure of the process."""
    found: list[bytes] = []

    def draw() -> None:
        found.append(
            figure_bytes(figures(thesis_tables, ["realism-matrix"])["realism-matrix"], "png")
        )

    threads = [threading.Thread(target=draw) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(found)) == 1


def test_equal_values_lie_side_by_side_around_zero() -> None:
    assert beeswarm([3, 3, 1, 3], step=0.1) == pytest.approx([-0.1, 0.0, 0.0, 0.1])


def test_named_lods_have_colours_of_their_own() -> None:
    lods = ["low", "ultra", "ultra-no-caustics", "ultra-no-sclera"]
    assert len({lod_colour(lod, lods) for lod in lods}) == 4
    assert lod_colour("compared-and-never-rated", lods) not in {
        lod_colour(lod, lods[:2]) for lod in lods[:2]
    }
    assert len(set(scale_colours(7))) == 7
