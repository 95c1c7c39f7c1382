"""``ocularist certify``: what it needs, what it writes, what it says at the end."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from renderer.certification import certificate, report, tracer
from renderer.certification.aims import Aim
from renderer.certification.plan import Plan
from study.cli import main

MET = Aim("furnace: mean of an even iris", 1.0, 0.1, "blue")
MISSED = Aim("RMS per channel in the iris, soft light", 3.0, 3.4, "brown-7-soft-box-50")


@dataclass
class Judged:
    """A certificate whose aims are given."""

    found: list[Aim]

    def aims(self) -> list[Aim]:
        return self.found


class Context:
    def release(self) -> None:
        """Give back nothing."""


@pytest.fixture
def measured(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Replace the measuring by given aims; keep what it was asked for."""
    asked: dict[str, Any] = {"aims": [MET]}

    def certify(_gl: object, _mi: object, plan: Plan, **given: Any) -> Judged:
        asked.update(given, plan=plan)
        given["progress"]("blue-1-constant-0")
        return Judged(asked["aims"])

    monkeypatch.setattr(certificate, "certify", certify)
    monkeypatch.setattr(report, "write_report", lambda _found, folder: folder / "report.html")
    monkeypatch.setattr(tracer, "check_installed", lambda: None)
    monkeypatch.setattr(tracer, "path_tracer", lambda _variant: None)
    monkeypatch.setattr("renderer.gl.context.create_context", Context)
    return asked


def test_met_aims_end_well(
    measured: dict[str, Any], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert main(["certify", "--quick", "--out", str(tmp_path), "--seed", "5"]) == 0
    out, err = capsys.readouterr()
    assert "met    furnace: mean of an even iris: 0.10 % (blue), wanted at most 1.00 %" in out
    assert f"Written to {tmp_path / 'report.html'}" in out
    assert err == "certify: blue-1-constant-0\n"
    assert measured["variant"] == tracer.SAFE_VARIANT
    assert measured["seed"] == 5


def test_a_missed_aim_is_a_failure(
    measured: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    measured["aims"] = [MET, MISSED]
    assert main(["certify", "--quick"]) == 1
    assert "MISSED RMS per channel in the iris, soft light: 3.40 %" in capsys.readouterr().out


def test_irises_and_paths_are_options(measured: dict[str, Any]) -> None:
    main(["certify", "--quick", "--iris", "3:green", "--iris", "hazel", "--spp", "32"])
    plan = measured["plan"]
    assert {case.iris for case in plan.cases} == {(3, "green"), (1, "hazel")}
    assert plan.spp == 32


def test_without_a_path_tracer_one_line_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    assert main(["certify", "--quick"]) == 1
    assert capsys.readouterr().err == (
        "ocularist certify: needs mitsuba and flip-evaluator, not installed here; "
        'pip install "ocularist[certify]"\n'
    )
