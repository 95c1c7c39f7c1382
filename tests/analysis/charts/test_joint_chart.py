"""The joint scale: drawn where everything is linked, told why not where it is not."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from analysis.charts.joint import NOT_FITTED, joint_scale, joint_table
from analysis.charts.material import Material
from analysis.estimates.linkage import Linkage

Texts = Callable[[Figure], list[str]]


def said_by(figure: Figure, texts_of: Texts) -> str:
    return " ".join(" ".join(texts_of(figure)).split())


def test_both_scales_and_the_unit_in_jod_are_drawn(
    material: Material, drawn_small: dict[str, Figure], texts_of: Texts
) -> None:
    table, figure = joint_table(material), drawn_small["joint-scale"]
    latent = figure.axes[0]
    ends = {tuple(line.get_xdata()) for line in latent.lines if len(line.get_xdata()) == 2}
    for name in ("latent", "alone"):
        free = table.iloc[1:]
        assert set(zip(free[f"{name}_low"], free[f"{name}_high"], strict=True)) <= ends
    joint = material.inference.joint
    assert joint is not None
    unit = joint.jod_per_unit()[0]
    low, high = latent.get_xlim()
    figure.canvas.draw()
    (top,) = latent.child_axes
    assert top.get_xlim() == pytest.approx((low * unit, high * unit))
    assert f"one unit of the latent scale is {unit:.2f} JOD" in said_by(figure, texts_of)
    shown = table["loss"].notna()
    assert np.isfinite(table.loc[shown, "width_ratio"]).all()


def test_what_nothing_links_is_told_and_not_drawn(material: Material, texts_of: Texts) -> None:
    groups = ((("near", "low"),), (("far", "low"),))
    apart = Linkage(compared=groups, linked=groups, unrated=())
    inferred = replace(material.inference, linkage=apart)
    said = said_by(joint_scale(Material(material.tables, None, inferred)), texts_of)
    assert "nobody rated eyes of two of these groups (near: low; far: low)" in said
    without = Material(material.tables, None, replace(inferred, joint=None))
    assert NOT_FITTED in said_by(joint_scale(without), texts_of)
    assert joint_table(without).empty
