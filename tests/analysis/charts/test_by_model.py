"""Perceived against actual LoD by the model: slopes, shares of ratings, tau with p and n."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from analysis.charts.by_model import perceived_by_model
from analysis.charts.by_model_table import by_model_table
from analysis.charts.material import Material
from analysis.charts.trends import NO_ORDER
from analysis.tables.reading import tables_from

Texts = Callable[[Figure], list[str]]


def test_shares_are_the_models_and_strokes_what_was_given(
    material: Material, drawn_small: dict[str, Figure]
) -> None:
    table = by_model_table(material)
    assert list(dict.fromkeys(zip(table["distance"], table["lod"], strict=True))) == [
        (where, lod) for where in ("near", "medium", "far") for lod in ("low", "high", "ultra")
    ]
    sums = table.groupby(["distance", "lod"])[["predicted", "share"]].sum()
    assert sums.to_numpy() == pytest.approx(1)
    assert (table["predicted_low"] < table["predicted_high"]).all()
    bars = [patch for axes in drawn_small["perceived-by-model"].axes for patch in axes.patches]
    drawn = np.array([bar.get_height() for bar in bars]).reshape(3, 5, 3)  # distance, rating, LoD
    assert drawn.transpose(0, 2, 1).ravel() == pytest.approx(table["predicted"].to_numpy())


def test_each_line_states_its_slope_and_tau_with_p_and_n(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table = by_model_table(material)
    near = table[(table["distance"] == "near") & (table["rating"] == 1)]
    x, y = near["lod_rank"].to_numpy(), near["latent"].to_numpy()
    assert near["slope"].iloc[0] == pytest.approx(np.polyfit(x, y, 1)[0])
    assert (table["slope_low"] < table["slope"]).all()
    said = [text for text in texts_of(drawn_small["perceived-by-model"]) if "per LoD" in text]
    assert [text.split(":")[0] for text in said] == ["near", "medium", "far"]
    assert f"{near['slope'].iloc[0]:.2f} per LoD" in said[0]
    assert all(" p " in text and ", n = " in text for text in said)


def test_lods_without_a_rank_have_no_order_to_follow(texts_of: Texts) -> None:
    frame = pd.DataFrame({"participant": ["A", "B"] * 2, "lod": ["x", "x", "y", "y"]})
    tables = tables_from({"ratings": frame.assign(rating=[1, 2, 3, 3])})
    assert NO_ORDER.split(",")[0] in " ".join(
        text.replace("\n", " ") for text in texts_of(perceived_by_model(Material(tables)))
    )
