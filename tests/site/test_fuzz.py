"""The site under hostile requests: whatever comes, no answer says that the fault was ours.

What the routes declare is fuzzed by schemathesis; forms, which declare nothing, by their names.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any

import httpx
import pytest
import schemathesis
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from study.site.app import create_app

EXAMPLES = settings(
    max_examples=6,
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=list(HealthCheck),
)
EVIL = (
    *("", "\x00", "a\x00b", "\u202e\u202dabc\u2066", "\ufeff", "\ud7ff\U0010ffff", "%00%ff"),
    *("<script>alert(1)</script>", "{{7*7}}${7*7}", "' OR 1=1 --", '=HYPERLINK("http://x")'),
    *("../../etc/passwd", "-1", "0", "1e309", "NaN", "9" * 400, "9" * 19, "x" * 100_000),
    *("\r\nSet-Cookie: a=b", "٣", "²"),
)
WORDS = st.sampled_from(EVIL) | st.text(max_size=40)


@pytest.fixture
def insider(site: Any) -> Iterator[httpx.Client]:
    """A browser of somebody at a trial who is signed in as a researcher too."""
    guest = site.guest()
    guest.sign_in()
    guest.walk_to_trial()
    guest.client.headers["X-CSRF-Token"] = guest.data("csrf")
    guest.client.follow_redirects = False
    yield guest.client
    guest.client.close()


def operations(site: Any) -> Iterator[Any]:
    """Every route with every method; the site itself shows its schema to nobody."""
    app = create_app(site.settings, study_id=site.study.id)
    schema = schemathesis.openapi.from_dict(app.openapi())
    app.state.place.db.close()
    for found in schema.get_all_operations():
        yield found.ok()


def call(client: httpx.Client, case: Any) -> httpx.Response:
    """Send what schemathesis made, with the client's cookies."""
    made = case.as_transport_kwargs(base_url=str(client.base_url).rstrip("/"))
    headers = {
        name: value
        for name, value in dict(made.get("headers") or {}).items()
        if name.lower() not in ("cookie", "host", "content-length", "transfer-encoding")
    }
    headers |= {"X-CSRF-Token": client.headers.get("X-CSRF-Token", "")}
    data = made.get("data")
    return client.request(
        made["method"],
        made["url"],
        params=made.get("params"),
        json=made.get("json"),
        content=data if isinstance(data, str | bytes) else None,
        headers={name: str(value).encode("utf-8", "replace") for name, value in headers.items()},
    )


def test_the_schema_is_shown_to_nobody(guest: Any) -> None:
    for path in ("/openapi.json", "/docs", "/redoc"):
        assert guest.get(path).status_code == 404


def test_no_declared_request_breaks_the_site(site: Any, insider: httpx.Client) -> None:
    tried = 0
    for operation in operations(site):

        @EXAMPLES
        @given(case=operation.as_strategy())
        def fuzz(case: Any) -> None:
            nonlocal tried
            tried += 1
            answer = call(insider, case)
            assert answer.status_code < 500, (case.method, answer.url, answer.text[-300:])
            assert "default-src 'none'" in answer.headers["content-security-policy"]

        fuzz()
    assert tried > 100


def test_no_form_breaks_the_site(site: Any, insider: httpx.Client) -> None:
    pages = ("/trial/1", "/stop", "/next", "/consent", "/researcher/results", "/researcher/sign-in")
    names = {"key", "response_ms", "version", "agree", "choice", "name", "password", "clock_ms"}
    proofs = {}
    for page in pages:
        text = insider.get(page).text
        names |= set(re.findall(r'name="([^"]+)"', text))
        proofs[page.split("/")[1]] = re.findall(r'name="csrf" value="([^"]*)"', text)[:1]
    posts = [one for one in operations(site) if one.method.upper() == "POST"]
    fields = st.dictionaries(st.sampled_from(sorted(names - {"csrf"})), WORDS, max_size=6)
    for operation in posts:
        if operation.path not in ("/events", "/stop", "/researcher/sign-out"):
            path = re.sub(r"\{\w+\}", "1", operation.path)
            proof = proofs.get(path.split("/")[1]) or proofs["trial"]
            form_fuzz(insider, path, proof, fields)()


def form_fuzz(
    insider: httpx.Client, path: str, proof: list[str], fields: st.SearchStrategy[dict[str, str]]
) -> Callable[[], None]:
    """Return what posts a form with all kinds of contents, with and without its proof."""

    @EXAMPLES
    @given(words=fields, has_proof=st.booleans())
    def fuzz(words: dict[str, str], has_proof: bool) -> None:
        sent = {**words, **({"csrf": proof[0]} if has_proof and proof else {})}
        body = {name: value.encode("utf-8", "replace") for name, value in sent.items()}
        answer = insider.post(path, data=body)
        assert answer.status_code < 500, (path, sent, answer.text[-300:])

    return fuzz


def test_hostile_words_are_stored_or_refused_and_exported_harmless(site: Any) -> None:
    person = site.guest()
    person.walk_to_trial()
    person.watch()
    kept = 0
    for number, evil in enumerate(EVIL):
        sent = person.send(
            kind="answer", key=f"evil-{number}", position=1, question="comments", value=evil
        )
        assert sent.status_code in (200, 422), (evil[:40], sent.text)
        kept += sent.status_code == 200 and sent.json()["ok"]
    assert kept > len(EVIL) / 2
    person.finish(comments='=HYPERLINK("http://evil.example")', what_differed="+1 or so")
    person.client.close()
    ada = site.guest()
    ada.sign_in()
    table = ada.get("/researcher/data/comparisons.csv").text
    # A spreadsheet would run a cell that begins so; the mark before it makes it text.
    assert "\"'=HYPERLINK(" in table
    assert ",'+1 or so," in table
    ada.client.close()
