"""Pages that were rendered once and are filled: with everybody's own, and nobody else's."""

from __future__ import annotations

import re
from typing import Any

from markupsafe import Markup

from study.site.mould import MOST, Moulds, mould_of, place


def test_a_mould_is_filled_with_escaped_values() -> None:
    mould = mould_of(f"<p>{place('name')}, {place('count')} of {place('name')}</p>")
    page = mould.fill({"name": "<b>&", "count": 3})
    assert page == "<p>&lt;b&gt;&amp;, 3 of &lt;b&gt;&amp;</p>"
    assert mould.fill({"name": Markup("<b>x</b>"), "count": ""}) == "<p><b>x</b>,  of <b>x</b></p>"


def test_moulds_are_rendered_once_until_there_are_too_many() -> None:
    moulds, rendered = Moulds(), []

    def render() -> str:
        rendered.append(1)
        return f"a {place('x')}"

    for _ in range(3):
        assert moulds.of("name", render).fill({"x": 1}) == "a 1"
    assert len(rendered) == 1
    for number in range(MOST):
        moulds.of(number, render)
    moulds.of("name", render)
    assert len(rendered) == MOST + 2


def test_a_page_of_a_mould_holds_nothing_of_whom_it_was_made_for(site: Any) -> None:
    first, second = site.guest(), site.guest()
    for guest in (first, second):
        guest.walk_to_trial()
    own = [
        set(
            re.findall(r'(?:data-session|data-csrf|data-outbox|data-key|value)="([^"]{12,})"', page)
        )
        for page in (first.get("/trial/1").text, second.get("/trial/1").text)
    ]
    assert own[0]
    assert own[1]
    cookies = [guest.client.cookies["ocularist_participant"] for guest in (first, second)]
    page = second.get("/trial/1").text
    assert "place-" not in page
    assert cookies[0] not in page
    for secret in own[0]:
        assert secret not in page
    for guest in (first, second):
        guest.client.close()
