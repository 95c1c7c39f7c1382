"""What the simulation of power leaves behind: tables, settings, a chart. The package's edge."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from analysis.charts.style import figure_bytes
from analysis.power.chart import power_chart
from analysis.power.outcome import Outcome
from analysis.power.sentences import answer_lines, needed_for

POWER_FILE, CHEAPEST_FILE = "power.csv", "power-cheapest.csv"
SETTINGS_FILE, CHART = "power.json", "power"


def write_power(
    outcome: Outcome, folder: Path, *, title: str, settings: Mapping[str, Any]
) -> list[Path]:
    """Write power.csv, power-cheapest.csv, power.json and the chart; returns the files."""
    folder.mkdir(parents=True, exist_ok=True)
    tables = {POWER_FILE: outcome.verdicts, CHEAPEST_FILE: outcome.cheapest}
    for name, table in tables.items():
        table.to_csv(folder / name, index=False, float_format="%.6g")
    told = {
        "simulated": True,
        **settings,
        "replicates": outcome.replicates,
        "answers": answer_lines(outcome),
        "people_needed": _needed(outcome),
    }
    text = json.dumps(told, indent=2, ensure_ascii=False)
    (folder / SETTINGS_FILE).write_text(text + "\n", encoding="utf-8")
    figure = power_chart(outcome, title=title)
    for kind in ("svg", "png"):
        (folder / f"{CHART}.{kind}").write_bytes(figure_bytes(figure, kind))
    return [folder / name for name in (*tables, SETTINGS_FILE, f"{CHART}.svg", f"{CHART}.png")]


def _needed(outcome: Outcome) -> list[dict[str, Any]]:
    """Return the people that 80 % takes, for every decision that can be made."""
    rows = []
    for _, own in outcome.cheapest.groupby("distance", sort=False):
        if not own["right"].isna().any():
            about = {"distance": own["distance"].iloc[0], "lod": own["right_lod"].iloc[0]}
            needed = asdict(needed_for(own, "right"))
            rows.append({**about, "decision": "named as the cheapest that is enough", **needed})
    for _, own in outcome.verdicts.groupby(["distance", "lod"], sort=False):
        name = str(own["right_verdict"].iloc[0])
        if name and not own[name].isna().any():
            about = {"distance": own["distance"].iloc[0], "lod": own["lod"].iloc[0]}
            rows.append({**about, "decision": name, **asdict(needed_for(own, name))})
    return rows
