"""Headers, foreign posts, static files, hostile text, and pages for what goes wrong."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from study.site.browsers import browser_family
from study.site.forms import question_rows
from study.site.resources import folder_version, resource_folder
from study.site.signatures import (
    csrf_token,
    is_csrf_token,
    is_simulation_token,
    read_researcher,
    sign_researcher,
    simulation_token,
)

PAGES = ("/", "/consent", "/declined", "/next", "/nothing", "/researcher/sign-in")


def test_every_page_is_self_contained_and_says_so(guest: Any) -> None:
    for path in PAGES:
        check_is_self_contained(guest.get(path))
    guest.agree()
    check_is_self_contained(guest.page)


def check_is_self_contained(page: Any) -> None:
    policy = page.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self';" in policy
    assert "unsafe" not in policy
    assert page.headers["cache-control"] == "no-store"
    assert page.headers["x-content-type-options"] == "nosniff"
    assert page.headers["referrer-policy"] == "same-origin"
    assert re.findall(r"(?:src|href|action)=\"(https?:)?//", page.text) == []
    code = page.text.replace('<script type="application/json" id="texts">', "")  # data, never run
    assert re.findall(r"<script(?![^>]* src=)|<style|\sstyle=|\son\w+=", code) == []


def test_static_files_are_kept_for_ever_under_their_version(guest: Any) -> None:
    page = guest.get("/").text
    [address] = re.findall(r'href="(/static/[0-9a-f]{12}/participant.css)"', page)
    answer = guest.client.get(address)
    assert answer.headers["content-type"].startswith("text/css")
    assert "immutable" in answer.headers["cache-control"]
    old = guest.client.get("/static/000000000000/participant.css")
    assert old.headers["cache-control"] == "no-store"
    script = guest.client.get(address.replace("participant.css", "outbox.js"))
    assert script.headers["content-type"].startswith("text/javascript")
    for name in ("nothing.css", "..%2Fpyproject.toml", "%2e%2e"):
        assert guest.client.get(f"/static/000000000000/{name}").status_code == 404


def test_a_post_from_another_sites_page_is_refused(site: Any) -> None:
    foreign = site.guest(origin="https://elsewhere.example")
    foreign.get("/consent")
    answer = foreign.post("/consent", version="1", agree=["1", "2"])
    assert answer.status_code == 403
    assert answer.text == "This request came from another site."
    foreign.client.close()
    own = site.guest(origin=site.url)
    own.agree()
    assert own.at == "/about-you"
    own.client.close()


def test_hostile_text_is_shown_as_text(guest: Any) -> None:
    evil = "</textarea><script>alert(1)</script>\x00\ud83d"
    guest.walk_to_trial()
    sent = guest.send(
        kind="answer",
        key="k",
        position=1,
        question="comments",
        value=evil.encode("utf-8", "replace").decode(),
    )
    assert sent.json()["ok"] is True
    page = guest.get("/trial/1").text
    assert "<script>alert" not in page
    assert "&lt;/textarea&gt;&lt;script&gt;" in page


UNREADABLE: tuple[dict[str, Any], ...] = (
    {},
    {"kind": "answer"},
    {"kind": "else", "key": "k"},
    {"kind": "answer", "key": "k", "position": 1, "question": "comments", "value": 7},
    {"kind": "play", "key": "", "position": 1, "play": {}},
    {"kind": "problem", "key": "k", "code": "x" * 1000},
)


def test_unreadable_entries_are_refused_and_nothing_breaks(guest: Any) -> None:
    guest.walk_to_trial()
    for entry in UNREADABLE:
        answer = guest.send(**entry)
        assert answer.status_code == 422, entry
        assert answer.json() == {"code": "NOT-READABLE"}


def test_a_page_that_does_not_exist_says_so_calmly(guest: Any) -> None:
    page = guest.get("/nothing")
    assert page.status_code == 404
    assert "There is no such page" in page.text
    assert "PAGE-404" in page.text


def test_a_fault_of_ours_shows_a_code_and_the_log_holds_the_cause(
    guest: Any, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ZeroDivisionError("the cause")

    guest.walk_to_trial()
    monkeypatch.setattr("study.site.trial_page.minutes_left", fail)
    page = guest.get("/trial/1")
    assert page.status_code == 500
    assert "That was our fault, not yours." in page.text
    [code] = re.findall(r"SITE-[0-9A-F]{6}", page.text)
    assert "the cause" not in page.text
    assert "default-src 'none'" in page.headers["content-security-policy"]
    assert any(code in record.message for record in caplog.records)


def test_resources_are_found_in_a_checkout_and_in_a_wheel(tmp_path: Path) -> None:
    assert (resource_folder("templates") / "participant" / "trial.html").is_file()
    package = tmp_path / "site-packages" / "study"
    (package / "static").mkdir(parents=True)
    (package.parent / "static").mkdir()
    assert resource_folder("static", package) == package / "static"
    with pytest.raises(FileNotFoundError, match=r"templates: no such folder at .*study/templates"):
        resource_folder("templates", package)


def test_a_changed_static_file_changes_the_version(tmp_path: Path) -> None:
    (tmp_path / "a.css").write_text("a {}")
    before = folder_version(tmp_path)
    (tmp_path / "a.css").write_text("b {}")
    assert folder_version(tmp_path) != before


def test_signatures_hold_for_their_purpose_and_secret_alone() -> None:
    assert is_csrf_token("secret", "cookie", csrf_token("secret", "cookie"))
    assert not is_csrf_token("secret", "other", csrf_token("secret", "cookie"))
    assert not is_csrf_token("secret", "cookie", "ünïcode")
    assert is_simulation_token("secret", simulation_token("secret"))
    assert not is_simulation_token("other", simulation_token("secret"))
    assert not is_simulation_token("secret", sign_researcher("secret", 1))
    assert read_researcher("secret", sign_researcher("secret", 7)) == 7
    assert read_researcher("secret", simulation_token("secret")) is None


def test_questions_about_left_and_right_stand_side_by_side(definition: Any) -> None:
    rows = [[question.id for question in row] for row in question_rows(definition.questions)]
    assert ["rating_left", "rating_right"] in rows
    assert sum(map(len, rows)) == len(definition.questions)


@pytest.mark.parametrize(
    ("user_agent", "family"),
    [
        ("Mozilla/5.0 (X11; Linux x86_64; rv:132.0) Gecko/20100101 Firefox/132.0", "Firefox"),
        ("Mozilla/5.0 AppleWebKit/537.36 Chrome/130.0 Safari/537.36 Edg/130.0", "Edge"),
        ("Mozilla/5.0 AppleWebKit/537.36 Chrome/130.0.0.0 Safari/537.36", "Chrome"),
        ("Mozilla/5.0 (Macintosh) AppleWebKit/605 Version/17.4 Safari/605.1.15", "Safari"),
        ("curl/8", "other"),
    ],
)
def test_browsers_are_known_by_family_only(user_agent: str, family: str) -> None:
    assert browser_family(user_agent) == family


def test_the_site_gives_a_sign_of_life(guest: Any) -> None:
    assert guest.get("/healthz").json() == {"ok": True, "study": "small"}


def test_a_body_without_end_is_refused(guest: Any) -> None:
    guest.walk_to_trial()
    much = "x" * 2_000_000
    headers = {"X-CSRF-Token": guest.data("csrf"), "Content-Type": "application/json"}
    assert guest.client.post("/events", content=much, headers=headers).status_code == 413
    # A single field has a lower limit of its own.
    assert guest.post("/trial/1", key="k", comments=much).status_code == 413
    assert guest.post("/trial/1", key="k", comments=much[:300_000]).status_code == 400
    assert "That did not work" in guest.page.text
    assert guest.get("/trial/1").status_code == 200
