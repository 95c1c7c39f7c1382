"""docs/tables.md lists every CSV file that analyse writes, with every column, in its order."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.charts import CHARTS
from analysis.charts.drawing import Drawing
from analysis.report.publish import analyse
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.simulation.simulated import simulate_tables
from analysis.tables.columns import EFFECTS, STANDARD_LODS
from analysis.tables.reading import tables_from

TEXT = (Path(__file__).parents[3] / "docs" / "tables.md").read_text(encoding="utf-8")
LODS = ("low", "ultra", "no-caustics")
NEEDED = {"simulated", "verdict", "margins", "confidence", "p_equivalent", "is_moved", "codes"}


def levels(lod: str) -> dict[str, str]:
    if lod in STANDARD_LODS:
        return {}
    return dict.fromkeys(EFFECTS, "ultra") | {"caustics": "off"}


def written(folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, list[str]]:
    """Return the columns of every CSV file of an analysis that has everything."""
    blank = {f"{chart.name}.{kind}": b"<svg/>" for chart in CHARTS for kind in ("svg", "png")}
    monkeypatch.setattr(Drawing, "start", lambda *_: None)
    monkeypatch.setattr(Drawing, "finish", lambda _: dict(blank))
    pairs = [(lod, other) for lod in LODS for other in ("ultra", lod)]
    clips = {
        f"{where}-{left}-{right}": Stimulus(
            where, POPULATION.iris_px[where], left, right, levels(left), levels(right)
        )
        for where in ("macroscopic", "far")
        for left, right in dict.fromkeys([*pairs, *(pair[::-1] for pair in pairs)])
    }
    spoilers = {0: "straight-liner"}
    frames = simulate_tables(clips, np.random.default_rng(4), participants=8, spoilers=spoilers)
    rows = [
        {"renderer": "r", "size": "1280x720", "distance": where, "iris_px": 100.0, "eyes": 2}
        | {"lod": lod, "ms_median": cost, "ms_mad": 0.1, "n": 20}
        for where in ("macroscopic", "far")
        for lod, cost in zip(LODS, (1.0, 4.0, 3.0), strict=True)
    ]
    bench = folder / "bench.json"
    bench.write_text(json.dumps({"rows": rows}))
    analyse(tables_from(frames), folder / "out", bench=bench)
    return {
        path.stem: [str(name) for name in pd.read_csv(path, nrows=0).columns]
        for path in (folder / "out").glob("*.csv")
    }


def listed() -> dict[str, list[str]]:
    section = TEXT.split("## What `analyse` writes\n")[1].split("\n## ")[0]
    rows = re.findall(r"^\| `([\w-]+)\.csv` \|[^|]*\|[^|]*\| (.*) \|$", section, flags=re.MULTILINE)
    return {name: re.findall(r"`([^`]+)`", columns) for name, columns in rows}


def test_every_file_is_listed_with_its_columns(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found, told = written(tmp_path, monkeypatch), listed()
    assert set(found) == set(told)
    assert {name: told[name] for name in found} == found


def test_every_column_is_explained_once() -> None:
    section = TEXT.split("## The columns of what `analyse` writes\n")[1].split("\n## ")[0]
    explained = re.findall(r"^\| `([^`]+)` \|", section, flags=re.MULTILINE)
    used = {name for columns in listed().values() for name in columns}
    assert len(explained) == len(set(explained))
    assert used >= NEEDED
    assert set(explained) == {name for name in used if not name.isdigit()}  # 1 to 5 are ratings
