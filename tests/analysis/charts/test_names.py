"""Anybody's names in charts: long ones are shortened, other scripts find a font or are told."""

from __future__ import annotations

import warnings

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.charts import CHARTS, fonts
from analysis.charts.drawing import draw_charts
from analysis.charts.fonts import Fonts, fonts_for
from analysis.charts.long_names import LONGEST, shorten, shortened
from analysis.charts.material import Material
from analysis.charts.names import chart_notes
from analysis.charts.style import figure_bytes
from analysis.tables.reading import Tables, tables_from

ENDLESS = "a name that goes on-" * 12  # 240 letters
FOX = "\N{FOX FACE}"


def tables_of(distances: list[str], lods: list[str]) -> Tables:
    rng = np.random.default_rng(5)
    rows = [
        {"participant": f"p{who}", "distance": distance, "clip": f"{distance}-{lod}", "eye": eye}
        | {"lod": own, "other_lod": other, "lod_rank": lods.index(own) + 1}
        | {"rating": int(rng.integers(1, 6))}
        for who in range(4)
        for distance in distances
        for lod in lods[:-1]
        for eye, own, other in (("left", lod, lods[-1]), ("right", lods[-1], lod))
    ]
    return tables_from({"ratings": pd.DataFrame(rows)})


def test_short_names_are_told_apart() -> None:
    short = shortened(["near", *(f"{ENDLESS}{n}{ENDLESS}" for n in range(3))])
    assert len(set(short.values())) == 3
    assert all(len(name) <= LONGEST for name in short.values())
    assert shortened(["ultra-no-tessellation"]) == {}


def test_a_name_broken_into_lines_or_within_another_is_found() -> None:
    figure = Figure()
    axes = figure.subplots()
    long = "one two three four five six seven"
    axes.set_title(f"at {long[:13]}\n{long[14:]}, iris 9 px")
    axes.set_xticks([0, 1], [long, "near"], rotation=90)
    shorten(figure, shortened([long]))
    assert axes.get_title() == "at one two three f…ix\nseven, iris 9 px"
    ticks = axes.get_xticklabels()
    assert [(tick.get_text(), tick.get_rotation()) for tick in ticks] == [
        ("one two three f…ix seven", 90.0),
        ("near", 90.0),
    ]


@pytest.mark.parametrize(
    "tables",
    [
        tables_of([f"distance{n:02d}" for n in range(13)], ["low", "ultra"]),
        tables_of([f"x{ENDLESS}", f"y{ENDLESS}"], [f"{n}{ENDLESS}" for n in "abcd"]),
    ],
    ids=["13 distances", "240 letters"],
)
def test_no_layout_collapses(tables: Tables) -> None:
    some = ("realism-matrix", "realism-per-clip", "realism-by-distance", "ratings-per-person")
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        warnings.simplefilter("error")
        own = [chart for chart in CHARTS if chart.name in some]
        patch.setattr("analysis.charts.drawing.CHARTS", own)
        assert len(draw_charts(Material(tables))) == 2 * len(some)


def test_many_distances_stand_in_bands() -> None:
    tables = tables_of([f"d{n}" for n in range(9)], ["low", "ultra"])
    [matrix] = [chart for chart in CHARTS if chart.name == "realism-matrix"]
    panels = [axes for axes in matrix.draw(Material(tables)).axes if isinstance(axes, Axes)]
    named = [[label.get_text() for label in axes.get_xticklabels()] for axes in panels]
    assert named == [["d0", "d1", "d2", "d3", "d4"], ["d5", "d6", "d7", "d8"]]


def test_only_what_no_font_has_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    assert fonts_for(["near", "Ёж", "قريب", "a\N{ZERO WIDTH JOINER}\N{VARIATION SELECTOR-16}"]) == (
        Fonts()
    )
    own = dict(fonts._paths())
    covered = {own["DejaVu Sans"]: frozenset(map(ord, "near")), "some": frozenset(map(ord, "中低"))}
    monkeypatch.setattr(fonts, "_covered", lambda path: covered.get(path, frozenset()))
    monkeypatch.setattr(fonts, "_paths", lambda: {**own, "Some Sans": "some"})
    fonts._chosen.cache_clear()
    found = fonts_for(["near", f"中低 {FOX}"])
    fonts._chosen.cache_clear()
    assert found == Fonts(("Some Sans",), FOX)
    assert found.sentence().startswith(f"Charts show boxes for {FOX}, which no font on this")


def test_a_fallback_font_draws_what_ours_lacks() -> None:
    """STIX comes with matplotlib too, and has letters that DejaVu Sans lacks."""
    paths = fonts._paths()
    lacking = fonts._covered(paths["STIXGeneral"]) - fonts._covered(paths["DejaVu Sans"])
    name = chr(min(number for number in lacking if chr(number).isalpha()))
    found = fonts_for([name])
    assert found.families
    assert not found.missing
    pictures = []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for chosen in (found, Fonts(missing=name)):
            with fonts.used(chosen):
                figure = Figure(figsize=(1, 1))
                figure.text(0.5, 0.5, name)
                pictures.append(figure_bytes(figure, "png"))
    assert pictures[0] != pictures[1]


def test_missing_characters_warn_nobody_and_are_told(
    monkeypatch: pytest.MonkeyPatch, thesis_tables: Tables
) -> None:
    monkeypatch.setattr(fonts, "_chosen", lambda wanted: Fonts((), "".join(map(chr, wanted))))
    tables = tables_of(["near", FOX], ["low", f"u{ENDLESS}"])
    [early] = [chart for chart in CHARTS if chart.name == "realism-matrix"]
    monkeypatch.setattr("analysis.charts.drawing.CHARTS", [early])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        draw_charts(Material(tables))
    told = chart_notes(tables)
    assert told[0].startswith(f"Charts show boxes for {FOX}, ")
    assert told[1] == (
        "Charts shorten names of more than 24 letters (of clips, 48); tables have them whole."
    )
    assert chart_notes(thesis_tables) == []
