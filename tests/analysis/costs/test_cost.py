"""Costs from bench.json: which rows count, and every fault of the file."""

import json
from pathlib import Path
from typing import Any

import pytest

from analysis.costs.cost import read_bench
from analysis.tables.parsing import TableError


def row(**changes: object) -> dict[str, Any]:
    return {
        "renderer": "llvmpipe",
        "size": "1920x1080",
        "distance": "near",
        "iris_px": 160.0,
        "eyes": 2,
        "lod": "low",
        "ms_median": 80.0,
        "ms_mad": 1.0,
        "n": 9,
        **changes,
    }


def write(folder: Path, content: object) -> Path:
    path = folder / "bench.json"
    path.write_text(json.dumps(content))
    return path


def test_costs_are_read_from_a_list_or_from_rows(tmp_path: Path) -> None:
    for content in ([row()], {"rows": [row()]}):
        costs = read_bench(write(tmp_path, content))
        assert costs.ms("near", "low") == 80.0
        assert costs.ms("far", "low") is None
        assert costs.condition == "2 eyes, 1920x1080 pixels, llvmpipe"


def test_the_largest_picture_with_most_eyes_of_one_renderer_counts(tmp_path: Path) -> None:
    rows = [
        row(ms_median=1.0, renderer="another"),
        row(ms_median=2.0, size="1280x720"),
        row(ms_median=3.0, eyes=1),
        row(ms_median=4.0),
        row(ms_median=5.0, lod=None, effect="caustics", level="high"),
        row(ms_median=6.0, part="lods", distance="far"),
        row(ms_median=7.0, part="crowd", crowd=30, distance="far"),
        row(ms_median=None, part="crowd", crowd=10, renderer="another"),
    ]
    costs = read_bench(write(tmp_path, rows))
    assert costs.ms("near", "low") == 4.0
    assert costs.ms("far", "low") == 6.0
    assert len(costs.table) == 2


def test_every_fault_is_reported_with_its_place(tmp_path: Path) -> None:
    path = write(tmp_path, [row(ms_median=-1), row(distance=None, size=None), 3])
    with pytest.raises(TableError) as caught:
        read_bench(path)
    assert caught.value.faults == (
        'bench.json: 0.ms_median: found "-1"; accepted: a number of at least 0',
        'bench.json: 1.distance: found "None"; accepted: some text',
        'bench.json: 1.size: found "None"; accepted: a size like 1920x1080',
        'bench.json: 2: found "3"; accepted: an object',
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "bench.json: not JSON"),
        ("{}", "bench.json: found no list of rows; accepted: bench.json"),
        ('"x"', "bench.json: found no list of rows; accepted: bench.json"),
    ],
)
def test_a_file_that_is_no_bench_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "bench.json"
    path.write_text(text)
    with pytest.raises(TableError, match=message):
        read_bench(path)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TableError, match=r"No such file or directory; accepted: bench\.json"):
        read_bench(tmp_path / "bench.json")


def test_a_bench_of_effects_alone_has_no_lod(tmp_path: Path) -> None:
    costs = read_bench(write(tmp_path, [row(lod=None, effect="caustics", level="high")]))
    assert costs.condition == "no LoD was measured"
    assert costs.ms("near", "low") is None
