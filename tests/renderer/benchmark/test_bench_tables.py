"""The tables and the chart, from known figures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from renderer.benchmark.chart import write_chart
from renderer.benchmark.printing import as_markdown, as_text
from renderer.benchmark.result import Bench
from renderer.benchmark.tables import tables_of


def cells(bench: Bench, title: str) -> dict[str, tuple[str, ...]]:
    table = next(table for table in tables_of(bench) if table.title == title)
    assert all(len(row) == len(table.head) for row in table.rows)
    return {row[0]: row[1:] for row in table.rows}


@pytest.fixture
def on_a_gpu(known: Bench) -> Bench:
    """The same as if a GPU had drawn it: whole frames in rows, 1.5 ms of each asked of Python."""
    about = replace(known.about, renderer="a GPU", clock="timer queries")
    rows = [
        replace(row, ms_median=row.ms_median / 50, row_ms=row.ms_median / 48, processor_ms=1.5,
                draw_calls=100, reads=0, wait_ms=0.0, gaps=0)
        if row.lod else row
        for row in known.rows
    ]  # fmt: skip
    return replace(known, about=about, rows=rows)


def test_every_part_has_its_table(known: Bench) -> None:
    assert [table.title for table in tables_of(known)] == [
        "Frames by LoD",
        "The processor by LoD",
        "Effects, from ultra",
        "Subsurface: samples against our integrator",
        "Cube maps by size of a face",
        "Cube maps in clips",
        "Crowd",
        "Aims on two cores with software GL",
        "What the aims for a GPU ask of this processor",
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
        "table, 2048 px": ("400.0 ± 0.5", "2.5", "20.0", "146"),
        "auto, 256 px": ("250.0 ± 0.5", "4", "20.0", "146"),
    }
    assert list(cells(known, "Cube maps by size of a face")) == ["128 px", "2048 px"]


def test_the_processors_part_stands_beside_every_lod(known: Bench) -> None:
    rows = cells(known, "The processor by LoD")
    assert rows["macroscopic, 2 eyes"] == ("5.0 (120)", "10.0 (120)", "15.0 (120)", "20.0 (120)")
    untold = [replace(row, processor_ms=None) for row in known.rows]
    titles = [table.title for table in tables_of(replace(known, rows=untold))]
    assert "The processor by LoD" not in titles


def test_a_gpus_rate_is_that_of_a_row_and_says_what_bounds_it(on_a_gpu: Bench) -> None:
    assert cells(on_a_gpu, "Frames by LoD")["macroscopic, 2 eyes"][1] == "2.0 ± 0.5 (480/s)"
    assert cells(on_a_gpu, "The processor by LoD")["macroscopic, 2 eyes"] == (
        "1.5 (100) GPU", "1.5 (100) GPU", "1.5 (100) GPU", "1.5 (100) GPU",
    )  # fmt: skip
    crowd = cells(on_a_gpu, "Crowd")["5 people"]
    assert crowd == ("group", "10 by size", "0.9 ± 0.5", "1.07e+03", "1.5", "100", "processor")


def test_a_time_that_counts_waiting_for_commands_is_an_upper_bound(on_a_gpu: Bench) -> None:
    gappy = [replace(row, gaps=5) if row.lod == "low" else row for row in on_a_gpu.rows]
    rows = cells(replace(on_a_gpu, rows=gappy), "Frames by LoD")
    assert [cell[0] for cell in rows["macroscopic, 2 eyes"][1:3]] == ["≤", "4"]


def test_the_aims_are_told_on_a_gpu(on_a_gpu: Bench) -> None:
    eyes, group = cells(on_a_gpu, "Aims on a GPU").values()
    assert eyes == ("120", "10.0 ± 0.5", "96", "1.5", "100", "GPU", "10.4", "0", "missed")
    assert group == ("60", "8.0 ± 0.5", "120", "1.5", "100", "GPU", "8.3", "0", "met")


def test_what_an_aim_waits_for_is_told(on_a_gpu: Bench) -> None:
    waiting = [replace(row, reads=2, wait_ms=5.0) for row in on_a_gpu.of_part("aims")]
    eyes, _ = cells(replace(on_a_gpu, rows=waiting), "Aims on a GPU").values()
    assert eyes[5:] == ("read-backs", "10.4", "2 (5.0 ms)", "missed")


def test_without_a_gpu_its_aims_are_judged_by_the_processor_alone(known: Bench) -> None:
    eyes, group = cells(known, "What the aims for a GPU ask of this processor").values()
    assert eyes == ("120", "10.0", "102", "0", "100", "out of reach")
    assert group == ("60", "6.0", "106", "0", "167", "within reach")


def test_software_gls_aims_are_told_at_their_size_and_cores(known: Bench) -> None:
    title = "Aims on two cores with software GL"
    assert cells(known, title) == {
        "two low eyes": ("120", "100.0 ± 0.5", "met"),
        "two ultra eyes, cubes auto": ("280", "250.0 ± 0.5", "met"),
        "two ultra eyes, cubes of 2048 px": ("400", "400.0 ± 0.5", "met"),
    }
    for change in ({"cores": 8}, {"size": "640x360"}):
        about = replace(known.about, **change)
        assert title not in [table.title for table in tables_of(replace(known, about=about))]


def test_the_start_is_summed(known: Bench) -> None:
    assert cells(known, "Start")["sum"] == ("50.50", "5.25")
    warm = [stage for stage in known.startup if stage.cache == "warm"]
    assert cells(replace(known, startup=warm), "Start")["sum"] == ("5.25",)


def test_the_conditions_head_both_forms(known: Bench) -> None:
    quick = replace(known, about=replace(known.about, is_quick=True))
    for text in (as_text(quick), as_markdown(quick)):
        first = " ".join(text.split("\n\n")[0].splitlines())
        for said in ("llvmpipe", "1920x1080 pixels", "wall time", "load 0.25", "--quick"):
            assert said in first
    assert "--quick" not in as_text(known)
    assert "| head | 20.00 | 2.00 |" in as_markdown(known).splitlines()
    assert "### Memory" in as_markdown(known).splitlines()


def test_prose_is_wrapped_for_a_terminal_and_not_for_a_document(known: Bench) -> None:
    def longest(text: str) -> int:
        return max(len(line) for line in text.splitlines() if "  " not in line and "|" not in line)

    assert longest(as_text(known)) <= 100 < longest(as_markdown(known))


def test_the_load_meanwhile_is_told_and_too_much_of_it_too(known: Bench, on_a_gpu: Bench) -> None:
    assert "load 0.25 before, 1.5 to 1.5 meanwhile" in as_markdown(known)
    assert "Other work" not in as_text(known)
    busy = replace(known, rows=[*known.rows, replace(known.rows[0], load=3.6)])
    assert "Other work was running: the benchmark itself makes a load of about 2." in as_text(busy)
    loaded = [replace(row, load=1.8) for row in on_a_gpu.rows]
    assert "a load of about 1. Times" in as_markdown(replace(on_a_gpu, rows=loaded))


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
