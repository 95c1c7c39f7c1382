"""Comparisons: what was answered, what the preference scale expects, what a side adds."""

from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.special import ndtr

from analysis.charts.choices import clip_comparisons, pair_comparisons
from analysis.charts.material import Material
from analysis.estimates.predicted_choices import choice_shares, pair_shares
from analysis.estimates.preference import JOD

Texts = Callable[[Figure], list[str]]


def test_without_differences_between_people_shares_are_closed_forms(material: Material) -> None:
    preference = material.inference.preference
    assert preference is not None
    assert preference.fit.model.effects == ()
    low, high = preference.fit.model.thresholds(preference.fit.parameters)
    places = dict(zip(preference.cells, preference.jod()[0] / JOD, strict=True))
    away = places["near", "ultra"] - places["near", "low"]
    found = choice_shares(preference, ("near", "low"), ("near", "ultra"))
    assert found == pytest.approx((ndtr(low - away), ndtr(high - away) - ndtr(low - away),
                                   1 - ndtr(high - away)))  # fmt: skip
    assert sum(pair_shares(preference, ("near", "low"), ("near", "ultra"))) == pytest.approx(1)
    assert choice_shares(preference, ("near", "low"), ("far", "ultra")) is None
    assert choice_shares(preference, ("near", "low"), ("near", "none")) is None


def test_strokes_stand_where_the_scale_expects_the_parts_to_meet(
    material: Material, drawn_small: dict[str, Figure]
) -> None:
    table = pair_comparisons(material)
    assert table.groupby(["distance", "lesser"])["predicted"].sum().to_numpy() == pytest.approx(1)
    # What was given and what the model makes of it: one number of shares for two of the model.
    assert (table["share"] - table["predicted"]).abs().max() < 0.25
    (axes,) = drawn_small["comparisons-per-pair"].axes
    strokes = [c.get_segments() for c in axes.collections if len(c.get_segments()) == 12]
    wanted = table["predicted"].to_numpy().reshape(6, 3)[:, :2].cumsum(axis=1).ravel()
    assert any(
        np.allclose([segment[0][0] for segment in segments], wanted) for segments in strokes[-1:]
    )


def test_the_side_bias_is_named_with_what_it_rests_on(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    assert set(clip_comparisons(material).columns) >= {"clip", "share", "predicted"}
    for name in ("comparisons-per-pair", "comparisons-per-clip"):
        (said,) = [text for text in texts_of(drawn_small[name]) if "side bias" in text]
        assert "an eye on the right gains" in said
        assert "JOD [" in said
        assert said.endswith("0 pairs shown both ways round")
