"""Tables that say little or nothing, through the real command: an answer or a clear statement.

Charts are left out: they take most of the time, and what they draw has tests of its own.
"""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from analysis.charts import CHARTS
from analysis.charts.drawing import Drawing
from study.cli import main

Row = tuple[str, str, str, str, int | str]
LODS = ("low", "high", "ultra")


@pytest.fixture(autouse=True)
def no_charts(monkeypatch: pytest.MonkeyPatch) -> None:
    blank = {f"{chart.name}.{kind}": b"<svg/>" for chart in CHARTS for kind in ("svg", "png")}
    monkeypatch.setattr(Drawing, "start", lambda *_: None)
    monkeypatch.setattr(Drawing, "finish", lambda _: dict(blank))


def analyse(folder: Path, rows: list[Row], comparisons: pd.DataFrame | None = None) -> int:
    names = ["participant", "distance", "lod", "other_lod", "rating"]
    folder.mkdir(parents=True, exist_ok=True)
    pd.DataFrame(rows, columns=names).to_csv(folder / "ratings.csv", index=False)
    if comparisons is not None:
        comparisons.to_csv(folder / "comparisons.csv", index=False)
    return main(["analyse", str(folder), "--out", str(folder / "out")])


RISING: dict[str, int | str] = {"low": 1, "high": 3, "ultra": 5}


def table(
    rate: dict[str, int | str] | int | str, *, people: int = 6, lods: tuple[str, ...] = LODS
) -> list[Row]:
    """Return ratings at two distances; ``rate`` is what everybody gives, or what by LoD."""
    return [
        (f"p{who}", where, lod, "ultra", rate[lod] if isinstance(rate, dict) else rate)
        for who, where, lod in itertools.product(range(people), ("near", "far"), lods)
    ]


def compared(answer: int | str, noticed: str, *, people: int = 6) -> pd.DataFrame:
    pairs = [("low", "ultra"), ("ultra", "low"), ("ultra", "ultra")]
    rows = [
        (f"p{who}", "near", left, right, answer, noticed)
        for who, (left, right) in itertools.product(range(people), pairs)
    ]
    names = ["participant", "distance", "left_lod", "right_lod", "comparison", "noticed"]
    return pd.DataFrame(rows, columns=names)


CASES: dict[str, tuple[list[Row], pd.DataFrame | None]] = {
    "one person": (table(RISING, people=1), compared(1, "yes", people=1)),
    "two people": (table(RISING, people=2), None),
    "one LoD": (table(3, lods=("low",)), None),
    "one rating": (table(3, people=1, lods=("low",))[:1], None),
    "two rows": (table(3, people=2, lods=("low",))[::2], None),
    "constant ratings": (table(3), compared(0, "no")),
    "all at the lowest": (table(1), None),
    "all at the highest": (table(5), None),
    "perfect separation": (table(RISING), None),
    "all ties": (table(RISING), compared(0, "unsure")),
    "everyone notices everything": (table(RISING), compared(1, "yes")),
    "nobody answered a comparison": (table(RISING), compared("", "")),
    "all missing": (table(""), None),
    "one cell missing": ([r for r in table(RISING) if r[1:3] != ("far", "low")], None),
    "a cell without a rating": ([(*r[:4], "" if r[1:3] == ("far", "low") else r[4])
                                 for r in table(RISING)], None),
    "comparisons of LoDs that nobody rated": (
        table(RISING),
        compared(1, "yes").replace({"low": "matt", "ultra": "gloss"}),
    ),
    "duplicate rows": (table(RISING) * 2, pd.concat([compared(1, "yes")] * 2)),
    "people who share no LoD": (
        [r for r in table(RISING) if (r[2] == "low") == (r[0] in ("p0", "p1", "p2"))],
        None,
    ),
    "every LoD has a name of its own": (
        [(p, d, f"mine-{lod}", "", rating) for p, d, lod, _, rating in table(RISING)],
        None,
    ),
    "only the header": ([], None),
}  # fmt: skip


SILENT = ("one person", "one rating", "one LoD", "all missing", "only the header", "two rows")


@pytest.mark.parametrize("case", CASES)
def test_an_answer_or_a_clear_statement(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows, comparisons = CASES[case]
    status = analyse(tmp_path, rows, comparisons)
    told = capsys.readouterr()
    assert status == 0, told.err
    report = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    for text in (told.out, report):
        assert not any(sign in text for sign in (">nan<", " nan ", "inf ", "NaN", "None of None"))
    assert told.out.strip()
    verdicts = tmp_path / "out" / "decision.csv"
    if case in SILENT:  # what allows no decision makes none
        assert not verdicts.exists()
        assert "is enough" not in told.out
    if verdicts.exists():
        found = pd.read_csv(verdicts)
        if comparisons is None:  # whether anybody would notice is not known
            assert "equivalent" not in set(found["verdict"])
        assert found[["realism_loss", "realism_loss_low", "realism_loss_high"]].notna().all().all()
        assert (found["realism_loss"].abs() <= 4).all()


small = st.integers(0, 2**32 - 1)


@settings(
    max_examples=8,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(small, st.integers(1, 5), st.integers(1, 12), st.booleans())
def test_whatever_small_table_comes_is_analysed(
    tmp_path_factory: pytest.TempPathFactory, seed: int, people: int, each: int, has_more: bool
) -> None:
    rng = np.random.default_rng(seed)
    names = (*LODS, "mine")[: rng.integers(1, 5)]
    rows: list[Row] = [
        (
            f"p{rng.integers(people)}",
            str(rng.choice(["near", "far", "desk"])),
            str(rng.choice(names)),
            str(rng.choice([*names, ""])),
            "" if rng.random() < 0.2 else int(rng.integers(1, 6)),
        )
        for _ in range(each)
    ]
    more = None
    if has_more:
        more = compared(0, "no", people=people)
        more["comparison"] = rng.choice(["-1", "0", "1", ""], len(more))
        more["noticed"] = rng.choice(["yes", "no", "unsure", ""], len(more))
    assert analyse(tmp_path_factory.mktemp("small"), rows, more) == 0
