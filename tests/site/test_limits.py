"""Limits on joining and reporting: nobody comes near them, and a flood is told to come later."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from datetime import timedelta
from functools import partial
from typing import Any

import pytest

from study.data import limits
from study.data.limits import Limit
from study.data.refusals import TooManyError
from study.site import pace as pace_module
from study.site import place
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


@pytest.fixture
def at_most_three(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a site take three reports in a minute, told to the database one by one."""
    monkeypatch.setattr(limits, "REPORTING", Limit("reporting", 3, timedelta(minutes=1)))
    monkeypatch.setattr(place, "Pace", partial(Pace, lot=1))


@pytest.mark.usefixtures("at_most_three")
@pytest.mark.parametrize("database_kind", ["sqlite"])
def test_who_reports_too_fast_is_told_to_send_it_later(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    answers = [guest.send(kind="problem", key=f"k{n}", code="X") for n in range(5)]
    assert [answer.status_code for answer in answers] == [200, 200, 200, 429, 429]
    for refused in answers[3:]:
        assert refused.json() == {"code": "TOO-MANY"}
        assert 0 < int(refused.headers["retry-after"]) <= 60
    other = site.guest()
    other.walk_to_trial()
    assert other.send(kind="problem", key="k", code="X").status_code == 200
    other.client.close()


@dataclass
class Sitting:
    """A minute that a test moves on, and the processes of a site that share a database."""

    db: Any
    now_s: float = 0.0

    def __post_init__(self) -> None:
        self.begun = self.db.now()
        self.db.now = lambda: self.begun + timedelta(seconds=self.now_s)
        self.told: list[str] = []

    def process(self, limit: Limit) -> Pace:
        def tell(name: str, times: int) -> None:
            self.told.append(name)
            limits.count(self.db, limit, name, times=times)

        return Pace(tell, lot=5, clock=lambda: self.now_s)


def reports(pace: Pace, name: str, times: int) -> int:
    """Report so often; returns how many reports were taken."""
    taken = 0
    for _ in range(times):
        with suppress(TooManyError):
            pace.check(name)
            taken += 1
    return taken


def test_the_processes_of_a_site_share_one_limit(site: Any) -> None:
    sitting = Sitting(site.db)
    limit = Limit("reporting", 20, timedelta(minutes=1))
    processes = [sitting.process(limit) for _ in range(4)]
    taken = sum(reports(pace, "a", 100) for pace in processes)
    assert 20 <= taken < 20 + 4 * 5
    # Who was refused is not asked about again until their minute is over.
    assert len(sitting.told) == 8
    with pytest.raises(TooManyError) as caught:
        processes[0].check("a")
    assert caught.value.wait_s == 60
    assert reports(processes[0], "b", 20) == 20
    sitting.now_s = 45.5
    with pytest.raises(TooManyError) as caught:
        processes[0].check("a")
    assert caught.value.wait_s == 15
    sitting.now_s = 60.0
    assert reports(processes[0], "a", 10) == 10


def test_who_reports_as_people_do_costs_the_database_nothing(site: Any) -> None:
    sitting = Sitting(site.db)
    pace = sitting.process(limits.REPORTING)
    for _ in range(100):
        pace.check("a")
        sitting.now_s += 16  # four reports a minute, a lot of five is never full in time
    assert sitting.told == []


def test_names_whose_minute_is_over_are_forgotten(
    site: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pace_module, "MANY", 10)
    sitting = Sitting(site.db)
    pace = sitting.process(Limit("reporting", 4, timedelta(minutes=1)))
    assert reports(pace, "flood", 6) == 4
    for number in range(100):
        pace.check(str(number))
        sitting.now_s += 10
    assert len(pace._untold) + len(pace._until) <= 11
