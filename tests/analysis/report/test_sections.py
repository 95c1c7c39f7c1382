"""The report's sections on people, texts and claims stand in the report and beside it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import analysis
from analysis.report.summary import Summary
from analysis.simulation.observers import Stimulus
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import tables_from

TITLES = ("The thesis's claims, on these data", "What people wrote", "Observers", "Reliability")


@pytest.fixture(scope="module")
def published(
    thesis_clips: dict[str, Stimulus], tmp_path_factory: pytest.TempPathFactory
) -> Summary:
    frames = simulate_tables(
        thesis_clips,
        np.random.default_rng(1),
        participants=12,
        spoilers={0: "straight-liner", 1: "side-picker"},
    )
    folder = tmp_path_factory.mktemp("sections")
    codes = folder / "codes.csv"
    said = frames["comparisons"].dropna(subset=["what_differed"])
    first = said[["participant", "trial"]].head(1).assign(codes="tessellation")
    first.to_csv(codes, index=False)
    return analysis.analyse(tables_from(frames), folder / "out", codes=codes)


def table(summary: Summary, name: str) -> pd.DataFrame:
    return pd.read_csv(summary.report.parent / f"{name}.csv", keep_default_na=False)


def test_the_sections_stand_in_the_report_in_order(published: Summary) -> None:
    text = published.report.read_text(encoding="utf-8")
    places = [text.index(f"<h2>{title.replace(chr(39), '&#39;')}</h2>") for title in TITLES]
    assert places == sorted(places)
    assert "straight-liner (gave nearly every eye the same rating), n\xa0=\xa01: S001." in text
    assert "Verdicts with and without flagged people." in text
    numbers = [int(part.split(".")[0]) for part in text.split("<caption><b>Table ")[1:]]
    assert numbers == list(range(1, len(numbers) + 1))


def test_flags_and_weights_stand_beside_the_report(published: Summary) -> None:
    observers = table(published, "observers").set_index("participant")
    assert observers.loc[["S001", "S002"], "flags"].tolist() == ["straight-liner", "side-picker"]
    assert observers.loc[["S001", "S002"], "weight"].tolist() == [0.1, 0.1]
    sensitivity = table(published, "verdict-sensitivity")
    assert {"without S001", "without S002"} < set(sensitivity["people"])


def test_codes_by_hand_reach_the_rates_and_the_claims(published: Summary) -> None:
    remarks = table(published, "remark-codes")
    assert remarks.loc[remarks["coded_by"] == "hand", "codes"].tolist() == ["tessellation"]
    claims = table(published, "claims").set_index("claim")
    assert claims.loc["Nobody notices tessellation", "found"].startswith("1 of 12 people")
    rates = table(published, "mention-rates").set_index(["distance", "code"])
    assert rates.loc[("all", "tessellation"), "count"] == 1


def test_faulty_codes_stop_before_anything_is_written(tmp_path: Path) -> None:
    frame = pd.DataFrame({"participant": ["A"], "lod": ["low"], "rating": [1]})
    with pytest.raises(analysis.TableError, match="not found"):
        analysis.analyse(
            tables_from({"ratings": frame}), tmp_path / "out", codes=tmp_path / "none.csv"
        )
    assert not (tmp_path / "out").exists()
