"""What limits counted does not outlive its time, nor a withdrawal."""

from __future__ import annotations

import asyncio
from datetime import timedelta
from typing import Any

import pytest
from sqlalchemy import select
from sqlalchemy.exc import OperationalError

from study.data import erasure, limits
from study.data.schema import LimitRow
from study.site.forgetting import EVERY_S, forget_regularly


def counted(site: Any) -> list[str]:
    """Return the kinds of what is counted of anybody."""
    with site.db.reading() as session:
        return sorted(session.scalars(select(LimitRow.kind)))


def test_of_somebody_who_withdrew_no_address_and_no_pace_stays(site: Any, guest: Any) -> None:
    guest.agree()
    limits.count(site.db, limits.REPORTING, "somebody")
    erasure.withdraw(site.db, site.people()[0])
    assert counted(site) == ["joining", "reporting"]  # or a flood could begin anew
    moment = site.db.now()
    for later, left in (
        (timedelta(minutes=2), ["joining"]),
        (timedelta(seconds=EVERY_S), []),
    ):
        site.db.now = lambda later=later: moment + later
        limits.forget(site.db)
        assert counted(site) == left


def test_the_site_forgets_again_and_again(
    site: Any, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    limits.count(site.db, limits.REPORTING, "somebody")
    moment, writing = site.db.now() + timedelta(minutes=2), site.db.writing
    site.db.now = lambda: moment

    def away() -> Any:
        raise OperationalError("DELETE", {}, Exception("the server is gone"))

    left: list[list[str]] = []

    async def pause(seconds: float) -> None:
        assert seconds == EVERY_S
        left.append(counted(site))
        monkeypatch.setattr(site.db, "writing", away if len(left) == 1 else writing)
        if len(left) == 3:
            raise asyncio.CancelledError

    with pytest.raises(asyncio.CancelledError):
        asyncio.run(forget_regularly(site.db, pause=pause))
    assert left == [["reporting"], ["reporting"], []]
    assert "limits could not be forgotten yet" in caplog.text
    assert "the server is gone" in caplog.text
