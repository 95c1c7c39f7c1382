"""What a study wants of screens, calibration and eyesight, and what follows from reports."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import ValidationError

from study.design.calibration import (
    CalibrationError,
    CalibrationReport,
    calibrated,
    calibration_facts,
    is_same_screen,
)
from study.design.definition import parse_definition, read_definition
from study.design.device_check import DeviceCheck, DeviceReport, findings, remote_hints
from study.design.device_facts import device_facts
from study.design.eyesight import EyesightReport, Ring, eyesight_facts, smallest_gap_px
from study.design.faults import DefinitionError
from study.design.parts import Size
from study.design.patches import PATCHES, STEPS, colour_error, steps_seen, strip_levels
from study.design.plates import plates

SIZES = (Size(width=1280, height=720), Size(width=1920, height=1080))
SEED = 4
GOOD: dict[str, Any] = {
    "screen_width_px": 1920,
    "screen_height_px": 1080,
    "window_width_px": 1900,
    "window_height_px": 950,
    "pixel_ratio": 1.0,
    "zoom": 1.0,
    "refresh_hz": 60.0,
    "refresh_jitter_ms": 0.3,
    "colour_depth": 24,
    "patches": [list(patch) for patch in PATCHES],
    "mbit_s": 40.0,
    "dark_counted": len(strip_levels(SEED, "dark")),
    "light_counted": len(strip_levels(SEED, "light")),
    "night_light": "off",
    "hdr": "unknown",
}
ALL = ("screen", "window", "refresh", "decoder", "bandwidth", "contrast", "light")


def verdicts(check: DeviceCheck | None = None, **changes: Any) -> dict[str, str]:
    report = DeviceReport.model_validate({**GOOD, **changes})
    found = findings(check or DeviceCheck(), report, sizes=SIZES, seed=SEED)
    return {one.item: one.verdict for one in found}


def stopping(check: DeviceCheck, **changes: Any) -> list[str]:
    report = DeviceReport.model_validate({**GOOD, **changes})
    return [one.item for one in findings(check, report, sizes=SIZES, seed=SEED) if one.stops]


def test_a_good_screen_is_good_at_everything() -> None:
    assert set(verdicts().values()) == {"good"}
    assert stopping(DeviceCheck(required=ALL)) == []


@pytest.mark.parametrize(
    ("item", "changes"),
    [
        ("device", {"is_phone": True}),
        ("screen", {"screen_width_px": 1279}),
        ("window", {"zoom": 1.1}),
        ("refresh", {"refresh_hz": 49.0}),
        ("decoder", {"patches": [[r, g, min(255, b + 5)] for r, g, b in PATCHES]}),
        ("bandwidth", {"mbit_s": 4.9}),
        ("contrast", {"dark_counted": len(strip_levels(SEED, "dark")) - 3}),
        ("contrast", {"light_counted": 20}),
        ("light", {"hdr": "on"}),
        ("remote", {"colour_depth": 16, "refresh_hz": 30.0}),
    ],
)
def test_each_item_is_found_bad_for_its_own_reason(item: str, changes: dict[str, Any]) -> None:
    found = verdicts(**changes)
    assert found[item] == "bad"
    others = {name: verdict for name, verdict in found.items() if name != item}
    assert set(others.values()) - {"bad" if item == "remote" else ""} == {"good"}


def test_only_what_a_study_requires_holds_people_up() -> None:
    bad = {"refresh_hz": 30.0, "colour_depth": 16, "night_light": "on", "zoom": 2.0}
    assert stopping(DeviceCheck(), **bad) == []
    assert stopping(DeviceCheck(required=("light", "refresh")), **bad) == ["refresh", "light"]
    assert stopping(DeviceCheck(required=()), is_phone=True) == ["device"]
    assert stopping(DeviceCheck(allow_phones=True), is_phone=True) == []


def test_what_nobody_could_measure_holds_nobody_up_but_a_question_wants_an_answer() -> None:
    unknown: dict[str, Any] = {"zoom": None, "refresh_hz": None, "patches": [], "mbit_s": None}
    found = verdicts(**unknown)
    assert [found[name] for name in ("window", "refresh", "decoder", "bandwidth")] == [
        "unknown"
    ] * 4
    unanswered = {"dark_counted": None, "hdr": None}
    assert verdicts(**unanswered)["light"] == verdicts(**unanswered)["contrast"] == "open"
    assert stopping(DeviceCheck(required=ALL), **unknown, **unanswered) == ["contrast", "light"]


def test_one_hint_at_a_remote_desktop_says_nothing() -> None:
    assert verdicts(colour_depth=16)["remote"] == "good"
    report = DeviceReport.model_validate({**GOOD, "refresh_hz": 30.0, "refresh_jitter_ms": 9.0})
    assert remote_hints(report) == ("refresh", "jitter")


def test_counting_cannot_be_guessed_from_the_number_of_steps() -> None:
    counts = {len(strip_levels(seed, "dark")) for seed in range(40)}
    assert counts == {len(STEPS) + extra for extra in (1, 2, 3)}
    total = len(strip_levels(SEED, "light"))
    assert steps_seen(total, SEED, "light") == 5
    assert steps_seen(total - 2, SEED, "light") == 3
    assert steps_seen(total + 1, SEED, "light") == steps_seen(0, SEED, "light") == 0
    assert steps_seen(None, SEED, "light") is None
    assert {255 - level for level in strip_levels(SEED, "light")} >= set(STEPS)


def test_the_colour_error_is_the_worst_patch() -> None:
    shown = [[float(v) for v in patch] for patch in PATCHES]
    assert colour_error(shown) == 0
    shown[7][2] += 3.26
    assert colour_error(shown) == 3.26
    assert colour_error(shown[:-1]) is None


def test_a_screens_facts_name_what_was_bad() -> None:
    report = DeviceReport.model_validate({**GOOD, "zoom": 1.25, "night_light": "on"})
    found = findings(DeviceCheck(), report, sizes=SIZES, seed=SEED)
    facts = device_facts(report, found, seed=SEED)
    assert facts["device_faults"] == "window light"
    assert (facts["dark_steps"], facts["colour_error"], facts["refresh_hz"]) == (5, 0.0, 60.0)


@pytest.mark.parametrize(
    "changes",
    [
        {"refresh_hz": float("nan")},
        {"refresh_hz": -1.0},
        {"screen_width_px": 0},
        {"codec": "x" * 61},
        {"patches": [[0, 0, 0]] * 65},
        {"hdr": "maybe"},
        {"more": 1},
        {"dark_counted": 21},
    ],
)
def test_a_report_without_reason_is_refused(changes: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        DeviceReport.model_validate({**GOOD, **changes})


MEASURED: dict[str, Any] = {
    "scale_method": "card",
    "card_widths_px": [342.0, 342.8],
    "distance_method": "blind_spot",
    "places_px": [[280.0, -282.0 - shift] for shift in (0, 2, -3, 1, 190)],
    "moved": "by_itself",
    "screen_width_px": 1920,
    "screen_height_px": 1080,
    "pixel_ratio": 1.0,
}


def test_a_calibration_gives_size_and_distance_with_their_errors() -> None:
    report = CalibrationReport.model_validate(MEASURED)
    found = calibrated(report)
    assert (found.repetitions, found.outliers) == (5, 1)
    facts = calibration_facts(report, found)
    assert facts["mm_per_px"] == pytest.approx(0.25, abs=1e-4)
    assert facts["view_dist_cm"] == pytest.approx(60, abs=1)
    assert facts["view_dist_cm_se"] == pytest.approx(4.4, abs=0.2)
    assert facts["calibration_skipped"] is None


def test_what_was_left_out_is_missing_with_its_reason() -> None:
    no_card = {
        **MEASURED,
        "scale_method": "skipped",
        "scale_skipped": "no_card",
        "card_widths_px": [],
        "distance_method": "skipped",
        "distance_skipped": "no_card",
        "places_px": [],
    }
    report = CalibrationReport.model_validate(no_card)
    facts = calibration_facts(report, calibrated(report))
    assert facts["calibration_skipped"] == "no_card"
    assert facts["mm_per_px"] is facts["view_dist_cm"] is None
    diagonal = {
        **MEASURED,
        "scale_method": "diagonal",
        "diagonal_inch": 24.0,
        "distance_method": "skipped",
        "distance_skipped": "one_eye",
    }
    report = CalibrationReport.model_validate(diagonal)
    facts = calibration_facts(report, calibrated(report))
    assert facts["mm_per_px"] == pytest.approx(0.2767, abs=1e-4)
    assert (facts["view_dist_cm"], facts["calibration_skipped"]) == (None, "one_eye")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"card_widths_px": []}, "scale: no measure by card"),
        ({"card_widths_px": [40.0]}, r"scale: 2\.14 mm lies outside 0\.03 to 1\.5"),
        ({"places_px": [[280, -280]] * 2}, "distance: 2 repetitions"),
        ({"places_px": [[-100, -140]] * 5}, r"distance: .* mm lies outside 150\.0 to 4000\.0"),
        ({"places_px": [[-20, 20]] * 5}, r"distance: the dot lies 10\.0 mm to the right"),
    ],
)
def test_measures_that_cannot_be_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(CalibrationError, match=message):
        calibrated(CalibrationReport.model_validate({**MEASURED, **changes}))


def test_zoom_keeps_the_screen_and_another_screen_does_not() -> None:
    before = (1920.0, 1.0)
    assert is_same_screen(before, (2400.0, 1.25))  # Chromium: the width in CSS pixels stays
    assert is_same_screen(before, (1920.0, 1.25))  # Firefox: the product does
    assert not is_same_screen(before, (2880.0, 2.0))


def rings(*told: tuple[int, bool]) -> tuple[Ring, ...]:
    return tuple(Ring(gap_px=gap, shown=2, said=2 if right else 6) for gap, right in told)


def test_the_smallest_gap_needs_three_rings_and_forgives_one_mistake() -> None:
    told = rings((5, True), (5, True), (5, True), (4, True), (4, False), (4, True), (4, True))
    assert smallest_gap_px(told) == 4
    assert smallest_gap_px(told[:-1]) == 5
    assert smallest_gap_px((*told, *rings((4, False)))) == 5
    assert smallest_gap_px(()) is None


def test_eyesight_has_angles_where_the_screen_was_measured() -> None:
    mine = plates(SEED)
    report = EyesightReport(
        rings=rings(*[(3, True)] * 3),
        digits=tuple(plate.digit if plate.kind != "deutan" else None for plate in mine),
        glasses="worn",
    )
    facts = eyesight_facts(report, mine, calibration={"mm_per_px": 0.25, "view_dist_cm": 60.0})
    assert (facts["smallest_gap_px"], facts["smallest_gap_arcmin"]) == (3, 4.3)
    assert facts["gap_limit_arcmin"] == 2.86
    assert (facts["control_plates_read"], facts["protan_plates_read"]) == (1, 2)
    assert (facts["deutan_plates_read"], facts["tritan_plates_read"]) == (0, 1)
    bare = eyesight_facts(report, mine, calibration={})
    assert "smallest_gap_arcmin" not in bare
    left_out = eyesight_facts(EyesightReport(plates_skipped=True), mine, calibration={})
    assert "protan_plates_read" not in left_out
    assert left_out["smallest_gap_px"] is None


def test_a_study_without_checks_stays_what_it_was(raw: dict[str, Any]) -> None:
    plain = parse_definition(raw)
    assert (plain.device_check, plain.calibration, plain.eyesight) == (None, None, None)
    checked = parse_definition({**raw, "device_check": {}, "calibration": {}, "eyesight": {}})
    assert checked.definition_hash != plain.definition_hash
    assert "device_check" in plain.to_json()
    for name in ("thesis", "approach"):
        assert read_definition(name).device_check is None


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        (
            {"device_check": {"required": ["remote"]}},
            r"device_check\.required\.0: .*'screen', 'window'.*found 'remote'",
        ),
        ({"device_check": {"min_steps": 6}}, r"device_check\.min_steps: .*5.*found 6"),
        (
            {"device_check": {"min_refresh": 60}},
            r'device_check\.min_refresh: unknown key "min_refresh".*"min_refresh_hz"',
        ),
        ({"calibration": {"repetitions": 2}}, r"calibration\.repetitions: .*3; found 2"),
        ({"eyesight": {"directions": 6}}, r"eyesight\.directions: .*4; found 6"),
    ],
)
def test_faults_stand_with_their_place(
    raw: dict[str, Any], tables: dict[str, Any], message: str
) -> None:
    with pytest.raises(DefinitionError, match=message):
        parse_definition({**raw, **tables})
