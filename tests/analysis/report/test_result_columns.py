"""docs/tables.md names every column of the results about sizes, effects and costs."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.costs.cost import COLUMNS, Costs
from analysis.inference import infer
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.simulation.simulated import simulate_tables
from analysis.tables.columns import EFFECTS
from analysis.tables.reading import tables_from

TABLES = Path(__file__).parents[2] / "docs" / "tables.md"
FILES = (
    *("decision", "effects-decision", "curves", "curve-points", "thresholds"),
    *("pareto", "joint-scale"),
)


@pytest.fixture(scope="module")
def written() -> dict[str, pd.DataFrame]:
    """Return the results of a small study with a LoD of each kind, timed."""
    levels = {lod: dict.fromkeys(EFFECTS, lod) for lod in ("low", "ultra")}
    levels["no-caustics"] = levels["ultra"] | {"caustics": "off"}
    shown = {}
    for distance in ("near", "far"):
        px = POPULATION.iris_px[distance]
        for lod, own in levels.items():
            shown[f"{distance} {lod}"] = Stimulus(distance, px, lod, "ultra", own, levels["ultra"])
    frames = simulate_tables(shown, np.random.default_rng(3), participants=4)
    for effect in EFFECTS:
        frames["ratings"][effect] = [levels[lod][effect] for lod in frames["ratings"]["lod"]]
    rows = [
        ("gl", "640x360", 2, "near", 160.0, lod, ms, 1.0, 9)
        for lod, ms in (("low", 9.0), ("ultra", 20.0))
    ]
    costs = Costs(pd.DataFrame(rows, columns=list(COLUMNS)), "2 eyes, 640x360 pixels, gl", 2.0)
    return infer(tables_from(frames), costs=costs).tables()


def documented(file: str) -> set[str]:
    """Return the columns that the table below a file's name in docs/tables.md names."""
    text = TABLES.read_text(encoding="utf-8")
    after = text.split(f"**`{file}.csv`**", 1)[1]
    table = after.split("| column |", 1)[1].split("\n\n", 1)[0]
    cells = [line.split("|")[1] for line in table.splitlines()[2:]]
    return {name for cell in cells for name in re.findall(r"`(\w+)`", cell)}


@pytest.mark.parametrize("file", FILES)
def test_every_column_is_explained(written: dict[str, pd.DataFrame], file: str) -> None:
    assert set(written[file]) <= documented(file)


def test_every_explained_column_is_written(written: dict[str, pd.DataFrame]) -> None:
    for group in (FILES[:2], FILES[2:5], FILES[5:6], FILES[6:]):
        made = {column for file in group for column in written[file]}
        assert documented(group[0]) <= made
