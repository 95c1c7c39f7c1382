"""bench.json: written, read again, and read by the analysis."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from analysis.costs.cost import read_bench as read_costs
from renderer.benchmark.result import Bench, read_bench, write_bench


def test_a_bench_is_the_same_after_writing_and_reading(known: Bench, tmp_path: Path) -> None:
    write_bench(known, tmp_path / "bench.json")
    assert read_bench(tmp_path / "bench.json") == known
    row = json.loads((tmp_path / "bench.json").read_text())["rows"][0]
    assert row["part"] == "lods"
    assert "effect" not in row  # missing is left out, never zero


def test_the_analysis_takes_the_frames_of_two_eyes_and_no_crowd(
    known: Bench, tmp_path: Path
) -> None:
    write_bench(known, tmp_path / "bench.json")
    costs = read_costs(tmp_path / "bench.json")
    assert costs.condition == "2 eyes, 1920x1080 pixels, llvmpipe"
    assert costs.ms("macroscopic", "ultra") == 400.0
    assert len(costs.table) == 8
    assert costs.ms("far", "ultra") != 110.0  # that is a crowd's frame


@pytest.mark.parametrize("content", ["[]", "{", '{"about": {}}', '{"rows": [], "work": []}'])
def test_a_file_that_is_no_bench_is_refused_by_name(content: str, tmp_path: Path) -> None:
    path = tmp_path / "other.json"
    path.write_text(content)
    with pytest.raises(ValueError, match=r"other\.json: no result of ocularist bench .*measure"):
        read_bench(path)
