"""The short way past the framework answers as the long one does, and pages are cast as rendered."""

from __future__ import annotations

import re
from typing import Any

import pytest
from fastapi import FastAPI

from study.site.express import wanted
from study.site.headers import HEADERS
from study.site.mould import mould_of, place
from study.site.parts import Parts


def scope(method: str, path: str, **more: Any) -> dict[str, Any]:
    return {"type": "http", "method": method, "path": path, "query_string": b"", **more}


@pytest.mark.parametrize(
    "asked",
    [
        scope("GET", "/events"),
        scope("HEAD", "/trial/1"),
        scope("GET", "/trial/"),
        scope("GET", "/trial/-1"),
        scope("GET", "/trial/1/2"),
        scope("GET", "/trial/١"),
        scope("GET", "/trial/1234567"),
        scope("GET", "/trial/1", query_string=b"lang=ar"),
        scope("POST", "/events", root_path="/study"),
        {"type": "websocket", "path": "/events"},
    ],
)
def test_whatever_is_not_quite_ordinary_takes_the_long_way(asked: dict[str, Any]) -> None:
    assert wanted(asked) is None


def test_both_ways_give_the_same_answers(guest: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    guest.walk_to_trial()
    page = guest.get("/trial/1").text
    csrf = re.findall(r'data-csrf="([^"]*)"', page)[0]
    entry = {"kind": "answer", "position": 1, "question": "rating_left", "value": "3"}

    def answers() -> list[Any]:
        """Ask for what can go right and wrong; what differs each time is left out."""
        token = {"X-CSRF-Token": csrf}
        found = [
            guest.client.get("/trial/1"),
            guest.client.get("/trial/9"),
            guest.client.post("/trial/1", data={"csrf": "forged"}),
            guest.client.post("/trial/1", data={"csrf": csrf, "key": "early"}),
            guest.client.post("/events", json={"key": "a", **entry}, headers=token),
            guest.client.post("/events", json={"key": "a", **entry}),
            guest.client.post("/events", json={"key": "b", **entry, "position": 7}, headers=token),
            guest.client.post("/events", json={"key": "c"}, headers=token),
            guest.client.post("/events", json={"key": "x" * 2_000_000}, headers=token),
            guest.client.post(
                "/events", json={"key": "a", **entry}, headers={"Origin": "http://x"}
            ),
        ]
        assert all(HEADERS.items() <= dict_of(one).items() for one in found)
        return [(one.status_code, one.headers.get("location"), bare(one.text)) for one in found]

    short = answers()
    short_again = answers()
    monkeypatch.setattr("study.site.express.wanted", lambda _scope: None)
    assert answers() == short_again
    assert [status for status, _, _ in short] == [200, 200, 403, 422, 200, 403, 409, 422, 413, 403]


def dict_of(answer: Any) -> dict[str, str]:
    return {name: answer.headers.get(name, "") for name in HEADERS}


def bare(text: str) -> str:
    return re.sub(r'name="key" value="[^"]*"|SITE-\w+|"new":\w+', "", text)


def test_the_framework_does_not_see_an_entry(guest: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    guest.walk_to_trial()

    async def fail(*_: object) -> None:
        raise AssertionError("the framework was asked")

    monkeypatch.setattr(FastAPI, "__call__", fail)
    assert guest.client.get("/trial/1").status_code == 200


def test_a_cast_page_is_the_rendered_one(guest: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    guest.walk_to_trial()
    cast = [guest.get("/trial/1").text for _ in range(2)]
    keys = {re.findall(r'name="key" value="(\w{32})"', page)[0] for page in cast}
    assert len(keys) == 2
    # Rows that are not the study's own have no mould.
    monkeypatch.setattr(Parts, "rows_of", lambda self, _questions: list(self.rows))
    rendered = guest.get("/trial/1").text
    assert {bare(page) for page in cast} == {bare(rendered)}


def test_a_mould_escapes_what_it_is_filled_with() -> None:
    mould = mould_of(f"<p>{place('who')} and {place('who')}: {place('what')}.</p>")
    filled = mould.fill({"who": "<b>", "what": place("x"), "unused": object()})
    assert filled == f"<p>&lt;b&gt; and &lt;b&gt;: {place('x')}.</p>"
    assert mould_of("no place").fill({}) == "no place"


def test_who_joins_and_leaves_passes_the_framework(
    guest: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: set[str] = set()
    keep = FastAPI.__call__

    async def noted(self: FastAPI, scope: Any, receive: Any, send: Any) -> None:
        seen.add(scope.get("path", ""))
        await keep(self, scope, receive, send)

    monkeypatch.setattr(FastAPI, "__call__", noted)
    guest.walk_to_trial()
    guest.get("/thanks")
    joining = {"/consent", "/continue", "/about-you", "/instructions", "/preparing", "/thanks"}
    assert seen.isdisjoint(joining | {"/preparing/state"})


@pytest.mark.parametrize(
    ("query", "is_short"),
    [
        (b"screen_width_px=1920&screen_height_px=1080", True),
        (b"screen_width_px=1920&lang=ar", False),
    ],
)
def test_a_query_is_known_of_one_page_alone(query: bytes, is_short: bool) -> None:
    asked = scope("GET", "/preparing/state", query_string=query)
    assert (wanted(asked) is not None) is is_short
    assert wanted({**asked, "path": "/consent"}) is None


@pytest.mark.parametrize("database_kind", ["sqlite"])
@pytest.mark.parametrize("query", ["", "?screen_width_px=0&screen_height_px=5"])
def test_a_screen_that_cannot_be_is_refused_on_both_ways(guest: Any, query: str) -> None:
    guest.walk_to_trial()
    short = guest.client.get(f"/preparing/state{query}")
    long = guest.client.get(f"/preparing/state{query or '?'}&lang=en")
    assert (short.status_code, short.json()) == (422, {"code": "NOT-READABLE"})
    assert (long.status_code, long.json()) == (422, {"code": "NOT-READABLE"})
