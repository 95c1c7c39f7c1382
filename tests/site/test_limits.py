"""Limits on joining and reporting: nobody comes near them, and a flood is told to come later."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest

from study.data import limits
from study.data.limits import Limit
from study.data.refusals import TooManyError
from study.site.pace import Pace


def test_a_flood_of_newcomers_is_told_when_to_come_back(
    site: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limits, "JOINING", Limit("joining", 2, timedelta(minutes=10)))
    guests = [site.guest() for _ in range(4)]
    for guest in guests[:2]:
        guest.agree()
        assert guest.at == "/about-you"
    refused = guests[2].agree()
    assert refused.status_code == 429
    assert 0 < int(refused.headers["retry-after"]) <= 600
    assert "Please wait a moment" in refused.text
    assert "default-src 'none'" in refused.headers["content-security-policy"]
    assert len(site.people()) == 2
    # Who is in goes on, and simulated people do not count.
    assert guests[0].post("/about-you", age="33").status_code == 200
    bot = site.guest(**site.simulation)
    bot.agree()
    assert bot.at == "/about-you"
    for guest in (*guests, bot):
        guest.client.close()


def test_the_limit_ends_with_its_time_and_is_everybodys_own(site: Any) -> None:
    limit = Limit("joining", 1, timedelta(minutes=10))
    moment = site.db.now()
    site.db.now = lambda: moment
    limits.count(site.db, limit, "a")
    with pytest.raises(TooManyError, match="too many requests; try again in 600 s"):
        limits.count(site.db, limit, "a")
    limits.count(site.db, limit, "b")
    moment += timedelta(minutes=10)
    limits.count(site.db, limit, "a")


_check = Pace.check


def _strict(pace: Pace, name: str) -> None:
    pace.most = 3
    _check(pace, name)


@pytest.mark.parametrize("database_kind", ["sqlite"])
def test_who_reports_too_fast_is_told_to_send_it_later(
    guest: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Pace, "check", _strict)
    guest.walk_to_trial()
    answers = [guest.send(kind="problem", key=f"k{n}", code="X") for n in range(4)]
    assert [answer.status_code for answer in answers] == [200, 200, 200, 429]
    assert answers[3].json() == {"code": "TOO-MANY"}
    assert 0 < int(answers[3].headers["retry-after"]) <= 60


def test_the_pace_is_counted_by_name_and_forgotten_after_a_minute() -> None:
    now = [0.0]
    pace = Pace(most=2, per_s=60, clock=lambda: now[0])
    for name in ("a", "a", "b"):
        pace.check(name)
    with pytest.raises(TooManyError) as caught:
        pace.check("a")
    assert caught.value.wait_s == 60
    now[0] = 60.0
    pace.check("a")
