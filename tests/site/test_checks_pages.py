"""The checks before the clips on the real pages: gate, remedy, way out, consent, tables."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi import FastAPI

from study import bots
from study.checking import (
    calibration_report,
    device_report,
    digits_of,
    eyesight_report,
    squares_of,
)
from study.commands.preparing import prepare
from study.commands.self_test import make_self_test
from study.data import before, events, export
from study.design import patches
from study.design.definition import StudyDefinition, parse_definition
from study.design.patches import self_test_name
from study.design.plates import plates
from study.settings import Settings
from study.simulate import simulate
from study.site.signatures import simulation_token

CHECKS: dict[str, Any] = {
    "device_check": {"required": ["screen", "refresh", "light"]},
    "calibration": {},
    "eyesight": {},
}


@pytest.fixture
def checks() -> dict[str, Any]:
    """The tables of the study file that a test is about."""
    return CHECKS


@pytest.fixture
def definition(definition: StudyDefinition, checks: dict[str, Any]) -> StudyDefinition:
    """The small study with checks."""
    return parse_definition(json.loads(definition.to_json()) | checks)


def walk_to_checks(guest: Any, **consent: Any) -> None:
    guest.get("/consent")
    fields = {"version": guest.hidden("version"), "agree": ["1", "2", "3", "4"], **consent}
    guest.post("/consent", **fields)
    guest.post("/about-you", age="33")


def send(guest: Any, report: dict[str, Any]) -> Any:
    """Send a check's report from the page on which the guest is."""
    return guest.post(guest.at, report=json.dumps(report), key=guest.hidden("key"))


def good_device(site: Any, person: int = 0) -> dict[str, Any]:
    return device_report(site.study.definition, squares_of(site.people()[person].seed))


def kinds(site: Any) -> list[str]:
    return [event.kind for event in events.history(site.db, site.people()[0])]


def row_of(site: Any) -> Any:
    return export.tables(site.db, site.study).participants.iloc[0]


def test_the_checks_come_one_after_the_other_and_fill_the_tables(site: Any, guest: Any) -> None:
    walk_to_checks(guest, health="yes")
    seed = site.people()[0].seed
    assert guest.at == "/device-check"
    for elsewhere in ("/calibration", "/eyesight", "/instructions", "/preparing"):
        assert guest.get(elsewhere).url.path == "/device-check"
    send(guest, good_device(site))
    assert guest.at == "/calibration"
    send(guest, calibration_report(site.study.definition, np.random.default_rng(1)))
    assert guest.at == "/eyesight"
    send(guest, eyesight_report(site.study.definition, digits_of(site.study.definition, seed)))
    assert guest.at == "/instructions"
    assert kinds(site)[-3:] == ["device_check", "calibration", "eyesight"]
    row = row_of(site)
    assert (row["refresh_hz"], row["colour_error"], row["codec"]) == (60, 0, "avc1.64000c")
    assert (row["dark_steps"], row["scale_method"], row["eyesight_test"]) == (5, "card", "taken")
    assert 30 < row["view_dist_cm"] < 100
    assert 0.06 < row["view_dist_cm_se"] / row["view_dist_cm"] < 0.09
    assert row["gap_limit_arcmin"] == row["smallest_gap_arcmin"] > 1
    assert [row[f"{kind}_plates_read"] for kind in ("control", "protan", "deutan", "tritan")] == [
        *(1, 2, 2, 1)
    ]
    book = export.tables(site.db, site.study).codebook["tables"]["participants"]
    assert "view_dist_cm_se" in {entry["name"] for entry in book}


def test_the_checks_pass_the_framework(
    site: Any, guest: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    walk_to_checks(guest, health="yes")
    seen: set[str] = set()
    keep = FastAPI.__call__

    async def noted(self: FastAPI, scope: Any, receive: Any, send: Any) -> None:
        seen.add(scope.get("path", ""))
        await keep(self, scope, receive, send)

    monkeypatch.setattr(FastAPI, "__call__", noted)
    seed = site.people()[0].seed
    send(guest, {**good_device(site), "refresh_hz": 30.0})
    send(guest, good_device(site))
    send(guest, calibration_report(site.study.definition, np.random.default_rng(1)))
    send(guest, eyesight_report(site.study.definition, digits_of(site.study.definition, seed)))
    assert guest.at == "/instructions"
    assert seen == set()


def test_each_person_counts_their_own_squares_and_has_their_own_distance(site: Any) -> None:
    """Pages are cast for many; what differs from one to the next is still theirs."""
    told = []
    for number in range(3):
        guest = site.guest()
        walk_to_checks(guest, health="yes")
        squares = re.findall(r'height="24" fill="rgb\((\d+),\1,\1\)"', guest.page.text)
        seed = site.people()[number].seed
        own = {strip: patches.strip_levels(seed, strip) for strip in ("dark", "light")}
        assert [int(grey) for grey in squares] == [*own["dark"], *own["light"]]
        send(guest, good_device(site, number))
        rng = np.random.default_rng(number)
        send(guest, calibration_report(site.study.definition, rng))
        facts = before.facts_of(site.db, site.people()[number], "calibration")
        told.append(str(round(facts["view_dist_cm"])))
        assert f"{told[-1]}" in re.findall(r"about (\d+) cm", guest.page.text)
        guest.client.close()
    assert len(set(told)) > 1


def test_a_gate_says_what_to_do_and_lets_people_out_kindly(site: Any, guest: Any) -> None:
    walk_to_checks(guest)
    bad = {**good_device(site), "refresh_hz": 30.0, "night_light": "on"}
    answer = send(guest, bad)
    assert answer.status_code == 422
    assert "Something has to change before you can go on." in answer.text
    assert 'action="/device-check/leave"' not in answer.text
    assert "/resume/" in answer.text
    # The way out opens after the second try, and not before.
    guest.post("/device-check/leave")
    assert guest.at == "/device-check"
    answer = send(guest, bad)
    assert 'action="/device-check/leave"' in answer.text
    assert "You have done nothing wrong." in answer.text
    guest.post("/device-check/leave")
    assert guest.at == "/screened-out"
    person = site.people()[0]
    assert person.outcome == "screened_out"
    history = events.history(site.db, person)
    failed = [event.payload for event in history if event.kind == "device_check_failed"]
    assert [one["stopping"] for one in failed] == [["refresh", "light"]] * 2
    assert failed[0]["report"]["refresh_hz"] == 30.0
    [out] = [event.payload for event in history if event.kind == "screened_out"]
    assert out["reason"] == "device_check"
    assert row_of(site)["outcome"] == "screened_out"
    assert guest.get("/device-check").url.path == "/screened-out"


def test_a_helped_screen_goes_on_and_what_is_only_recorded_stops_nobody(
    site: Any, guest: Any
) -> None:
    walk_to_checks(guest)
    send(guest, {**good_device(site), "hdr": "on"})
    assert guest.at == "/device-check"
    send(guest, {**good_device(site), "zoom": 1.5, "mbit_s": 0.5, "dark_counted": 1})
    assert guest.at == "/calibration"
    assert row_of(site)["device_faults"] == "window bandwidth contrast"


def test_an_unreadable_report_is_asked_for_again(site: Any, guest: Any) -> None:
    walk_to_checks(guest)
    for report in ("", "{", "[]", '{"screen_width_px": "wide"}', '{"screen_width_px": NaN}'):
        answer = guest.post("/device-check", report=report)
        assert answer.status_code == 422
        assert "The check did not arrive as it should." in answer.text
    assert "device_check" not in kinds(site)


def test_sending_twice_stores_once(site: Any, guest: Any) -> None:
    walk_to_checks(guest)
    fields = {"report": json.dumps(good_device(site)), "key": guest.hidden("key")}
    csrf = guest.hidden("csrf")
    guest.post("/device-check", **fields)
    answer = guest.client.post("/device-check", data={**fields, "csrf": csrf})
    assert answer.url.path == "/calibration"
    assert kinds(site).count("device_check") == 1


def test_impossible_measures_are_asked_for_again(site: Any, guest: Any) -> None:
    walk_to_checks(guest)
    send(guest, good_device(site))
    report = calibration_report(site.study.definition, np.random.default_rng(1))
    answer = send(guest, {**report, "places_px": [[-300, -310]] * 5})
    assert "The distance cannot be right." in answer.text
    answer = send(guest, {**report, "card_widths_px": [8000.0]})
    assert "The size of the card cannot be right." in answer.text
    assert "The measurement did not arrive" in send(guest, {"scale_method": "eye"}).text
    skipped = {"distance_method": "skipped", "distance_skipped": "motion", "places_px": []}
    send(guest, {**report, **skipped})
    assert guest.at == "/instructions"  # nobody agreed to an eyesight test
    row = row_of(site)
    assert row["calibration_skipped"] == "motion"
    assert row.isna()["view_dist_cm"]
    assert row["mm_per_px"] > 0.1


class TestWithoutTheStudysOwnHealthConsent:
    """A study whose consent does not ask about health: the eyesight page asks by itself."""

    @pytest.fixture
    def definition(self, definition: StudyDefinition) -> StudyDefinition:
        data = json.loads(definition.to_json())
        del data["consent"]["health"]
        return parse_definition(data)

    @pytest.fixture
    def checks(self) -> dict[str, Any]:
        return {"eyesight": {}}

    def test_eyesight_needs_a_tick_of_its_own(self, site: Any, guest: Any) -> None:
        walk_to_checks(guest)
        assert "These are data about your health" in guest.page.text
        assert "This is no medical test." in guest.page.text
        assert guest.client.get("/eyesight/plates/1.svg").status_code == 404
        answer = guest.post("/eyesight/consent")
        assert "please tick the sentence" in answer.text
        guest.get("/eyesight")
        guest.post("/eyesight/consent", agree="yes")
        assert 'data-page="eyesight"' in guest.page.text
        seed = site.people()[0].seed
        drawn = guest.client.get("/eyesight/plates/1.svg")
        assert drawn.headers["content-type"] == "image/svg+xml"
        assert drawn.text.startswith("<svg")
        assert guest.client.get(f"/eyesight/plates/{len(plates(seed)) + 1}.svg").status_code == 404
        answer = guest.post("/eyesight", report='{"rings": 3}')
        assert "The test did not arrive as it should." in answer.text
        send(guest, {"rings": [], "rings_skipped": True, "plates_skipped": True})
        assert guest.at == "/instructions"
        assert row_of(site)["eyesight_test"] == "taken"

    def test_refusing_leaves_the_test_out(self, site: Any, guest: Any) -> None:
        walk_to_checks(guest)
        guest.post("/eyesight/consent", choice="no", agree="yes")
        assert guest.at == "/instructions"
        assert row_of(site)["eyesight_test"] == "refused"
        assert row_of(site).isna()["smallest_gap_px"]


def test_the_self_test_is_made_once_and_served(site: Any, guest: Any) -> None:
    walk_to_checks(guest)
    assert 'data-item="decoder"' not in guest.page.text
    path = make_self_test(site.settings.media_folder)
    before = path.stat().st_mtime_ns
    assert make_self_test(site.settings.media_folder).stat().st_mtime_ns == before
    assert path.stat().st_size < 20_000
    assert [one.name for one in path.parent.glob(".*self-test*")] == []
    address = f"/self-test/{self_test_name()}"
    assert address in guest.get("/device-check").text
    answer = guest.client.get(address, headers={"Range": "bytes=0-1"})
    assert (answer.status_code, answer.headers["content-type"]) == (206, "video/mp4")
    assert guest.client.get("/self-test/other.mp4").status_code == 404


def test_bots_and_simulated_people_pass_the_checks_and_irises_get_their_angle(site: Any) -> None:
    token = simulation_token(site.settings.secret_key())
    bots.walk(
        site.url,
        site.study.definition,
        media_folder=site.settings.media_folder,
        simulation_token=token,
        participants=1,
        seed=3,
    )
    simulate(site.db, site.study.definition, participants=1, seed=4)
    tables = export.tables(site.db, site.study)
    assert list(tables.participants["status"]) == ["completed"] * 2
    assert (tables.participants["view_dist_cm"] > 30).all()
    assert list(tables.participants["protan_plates_read"].dropna()) == [2]
    ratings = tables.ratings.merge(tables.participants, on="participant")
    size_mm = ratings["iris_px"] * ratings["mm_per_px"]
    expected = np.degrees(2 * np.arctan((size_mm / 20 / ratings["view_dist_cm"]).astype(float)))
    assert np.allclose(ratings["iris_deg"].astype(float), expected, rtol=1e-3)
    share = (ratings["iris_deg_se"] / ratings["iris_deg"]).astype(float)
    assert share.between(0.07, 0.09).all()
    assert (tables.ratings["shown_scale_se"] < 0.001).all()
    assert tables.comparisons["iris_deg"].notna().all()


def test_starting_a_site_makes_the_self_test_where_a_study_wants_it(tmp_path: Path) -> None:
    for name in ("thesis", "lod"):
        settings = Settings(
            data_folder=tmp_path / name,
            database_url=f"sqlite:///{tmp_path}/{name}/study.sqlite3",
            media_folder=tmp_path / name / "clips",
        )
        prepare(settings, name).db.close()
        assert (settings.media_folder / self_test_name()).is_file() == (name == "lod")
