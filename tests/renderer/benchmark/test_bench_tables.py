"""The tables and the chart, from known figures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from renderer.benchmark.chart import write_chart
from renderer.benchmark.printing import as_markdown, as_text
from renderer.benchmark.result import Bench
from renderer.benchmark.tables import tables_of


def cells(bench: Bench, title: str) -> dict[str, tuple[str, ...]]:
    table = next(table for table in tables_of(bench) if table.title == title)
    assert all(len(row) == len(table.head) for row in table.rows)
    return {row[0]: row[1:] for row in table.rows}


def test_every_part_has_its_table(known: Bench) -> None:
    assert [table.title for table in tables_of(known)] == [
        "Frames by LoD",
        "Effects, from ultra",
        "Subsurface: samples against our integrator",
        "Cube maps by size of a face",
        "Cube maps in clips",
        "Crowd",
        "Work of one eye",
        "Work of each effect",
        "Start",
        "Memory",
    ]
    assert tables_of(Bench(about=known.about)) == []


def test_frames_come_with_their_rate(known: Bench) -> None:
    rows = cells(known, "Frames by LoD")
    assert rows["macroscopic, 2 eyes"][:2] == ("350", "100.0 ± 0.5 (10/s)")
    assert rows["macroscopic, one eye"][4] == "200.0 ± 0.5 (5/s)"


def test_a_level_that_is_none_says_so_and_one_not_measured_too(known: Bench) -> None:
    rows = cells(known, "Effects, from ultra")
    assert rows["caustics"] == ("none", "none", "3.0 ± 0.5", "-")
    assert rows["texture"] == ("1.0 ± 0.5", "-", "-", "12.0 ± 0.5")


def test_samples_stand_beside_ours_with_their_error(known: Bench) -> None:
    rows = cells(known, "Subsurface: samples against our integrator")
    assert rows["left sum, 10 samples"] == ("11", "346", "20.0 ± 0.5", "25.00", "+20.00")
    assert rows["ours at ultra"] == ("1", "-", "40.0 ± 0.5", "0.60", "-0.02")


def test_clips_cubes_are_whole_frames_beside_the_sizes(known: Bench) -> None:
    assert cells(known, "Cube maps in clips") == {
        "table, 2048 px": ("400.0 ± 0.5", "2.5"),
        "auto, 256 px": ("250.0 ± 0.5", "4"),
    }
    assert list(cells(known, "Cube maps by size of a face")) == ["128 px", "2048 px"]


def test_the_start_is_summed(known: Bench) -> None:
    assert cells(known, "Start")["sum"] == ("50.50", "5.25")
    warm = [stage for stage in known.startup if stage.cache == "warm"]
    assert cells(replace(known, startup=warm), "Start")["sum"] == ("5.25",)


def test_the_conditions_head_both_forms(known: Bench) -> None:
    quick = replace(known, about=replace(known.about, is_quick=True))
    for text in (as_text(quick), as_markdown(quick)):
        first = text.splitlines()[0]
        for said in ("llvmpipe", "1920x1080 pixels", "wall time", "load 0.25", "--quick"):
            assert said in first
    assert "--quick" not in as_text(known)
    assert "| head | 20.00 | 2.00 |" in as_markdown(known).splitlines()
    assert "### Memory" in as_markdown(known).splitlines()


def test_the_chart_is_a_picture_and_a_drawing(known: Bench, tmp_path: Path) -> None:
    paths = write_chart(known, tmp_path / "deep" / "bench")
    assert [path.name for path in paths] == ["bench.png", "bench.svg"]
    pixels = np.asarray(Image.open(paths[0]).convert("RGB"))
    assert pixels.shape[1] > 1200
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 50
    assert paths[1].read_text(encoding="utf-8").startswith("<?xml")


def test_without_times_there_is_no_chart(known: Bench, tmp_path: Path) -> None:
    assert write_chart(replace(known, rows=[]), tmp_path / "bench") == []
    assert list(tmp_path.iterdir()) == []
