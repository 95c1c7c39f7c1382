"""``ocularist bench`` at the command line, without measuring."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from renderer.benchmark.plan import Progress
from renderer.benchmark.result import PARTS, About, Bench, Cost
from study.cli import main

ABOUT = About(
    renderer="llvmpipe", gl_version="4.5", clock="wall time", size="64x64", code_version="0",
    processor="one", cores=2, load_before=0.0, is_quick=True, seconds=1.0,
)  # fmt: skip
BENCH = Bench(
    about=ABOUT,
    rows=[
        Cost(part="lods", renderer="llvmpipe", size="64x64", distance="far", iris_px=12.0, eyes=2,
             lod="ultra", ms_median=20.0, ms_mad=1.0, n=3, load=0.5)
    ],
)  # fmt: skip


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """What the command asked to be measured."""
    calls: list[dict[str, Any]] = []

    def measured(parts: tuple[str, ...], **options: Any) -> Bench:
        calls.append({"parts": tuple(parts), **options})
        options["progress"](Progress("lods: far, two eyes", 0.5, 100.0))
        return BENCH

    monkeypatch.setattr("renderer.benchmark.plan.run_bench", measured)
    return calls


def test_it_measures_writes_draws_and_prints(
    asked: list[dict[str, Any]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "b.json"
    options = ["--quick", "--only", "lods", "--only", "work", "--size", "64x64"]
    assert main(["bench", *options, "--out", str(out)]) == 0
    assert asked[0]["parts"] == ("lods", "work")
    assert asked[0]["is_quick"]
    assert asked[0]["size"] == (64, 64)
    assert json.loads(out.read_text())["rows"][0]["ms_median"] == 20.0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b.json", "b.png", "b.svg"]
    told = capsys.readouterr()
    assert "20.0 ± 1.0 (50/s)" in told.out
    assert "bench: lods: far, two eyes (50%, about 2 min left)" in told.err


def test_everything_is_measured_unless_told_otherwise(
    asked: list[dict[str, Any]], tmp_path: Path
) -> None:
    assert main(["bench", "--out", str(tmp_path / "b.json")]) == 0
    assert asked[0]["parts"] == PARTS
    assert asked[0]["size"] is None


def test_a_file_is_printed_again_without_measuring(
    asked: list[dict[str, Any]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "b.json"
    main(["bench", "--out", str(out)])
    capsys.readouterr()
    assert main(["bench", "--from", str(out), "--markdown"]) == 0
    assert len(asked) == 1
    assert "| far, 2 eyes | 12 | - | - | - | 20.0 ± 1.0 (50/s) |" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--from", "{folder}/absent.json"], "absent.json"),
        (["--out", "{folder}/bench.txt"], "write a file's name that ends in .json"),
    ],
)
def test_what_cannot_be_read_or_written_is_told_in_a_line(
    options: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = [option.format(folder=tmp_path) for option in options]
    assert main(["bench", *given]) == 1
    [line] = capsys.readouterr().err.splitlines()
    assert line.startswith("ocularist bench: ")
    assert message in line


def test_an_unknown_part_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["bench", "--only", "speed"])
    assert "choose from 'lods', 'effects'" in capsys.readouterr().err
