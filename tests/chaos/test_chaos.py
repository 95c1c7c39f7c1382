"""Sessions through a real server that is killed, over connections that break: nothing is lost.

Everybody behaves as a browser does: entries are sent again under their keys, pages opened again.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from study.data import collection, export
from study.data.studies import Study
from study.load.person import Person
from study.load.proxy import Proxy
from study.load.site import LoadedSite
from study.load.trouble import CUTS, Killer, Trouble
from study.load.visit import Acknowledged
from study.load.wire import Wire

STEPS = ("page", "consent", "form", "play", "answer", "questionnaire")
PATIENCE_S = 900  # a loaded machine is no failure


@dataclass
class Outcome:
    """What a crowd in trouble was told, and what happened to it."""

    stored: list[Acknowledged]
    seen: Counter[tuple[str, str]]
    kills: int
    cuts: int

    def __str__(self) -> str:
        kinds = Counter[str]()
        for (what, _), times in self.seen.items():
            kinds[what] += times
        entries = sum(len(one.entries) for one in self.stored)
        forms = sum(len(one.forms) for one in self.stored)
        return (
            f"{len(self.stored)} people, {entries} entries and {forms} questionnaires "
            f"acknowledged; {self.kills} kills, {self.cuts} connections cut; "
            + ", ".join(f"{what} x{times}" for what, times in sorted(kinds.items()))
        )


@pytest.fixture
def site(thesis_text: str, tmp_path: Path, database_url: str) -> Iterator[LoadedSite]:
    """A site with the thesis's study, cut to its practice clip and its first two trials."""
    head, *clips = thesis_text.split("[[clips]]\n")
    last, rest = clips[-1].split("\n[consent]", 1)
    study = tmp_path / "small.toml"
    study.write_text("[[clips]]\n".join([head, *clips[:1], last]) + "\n[consent]" + rest)
    one = LoadedSite(tmp_path / "data", database_url, study_name=str(study))
    one.folder.mkdir()
    yield one
    one.kill()


async def live_through(
    site: LoadedSite, study: Study, *, people: int, share: float, kills: tuple[str, ...], seed: int
) -> Outcome:
    """Lead people through a study while their requests and the server come to grief."""
    site.start()
    await site.wait()
    seen: Counter[tuple[str, str]] = Counter()
    killer = Killer(site, list(kills))

    async def one(number: int, proxy: Proxy) -> Acknowledged:
        rng = np.random.default_rng([seed, number])
        person = Person(
            Wire(f"http://127.0.0.1:{proxy.port}"),
            rng,
            definition=study.definition,
            mischief=Trouble(proxy, killer, rng, share, seen),
            # Where it takes long to start, the server is hardly ever there: PATIENCE_S ends that.
            tries=10_000,
        )
        return await person.walk()

    async with contextlib.AsyncExitStack() as stack, asyncio.timeout(PATIENCE_S):
        proxies = [await stack.enter_async_context(Proxy(site.port)) for _ in range(people)]
        stored = await asyncio.gather(*(one(n, proxy) for n, proxy in enumerate(proxies)))
        return Outcome(stored, seen, killer.kills, sum(proxy.done for proxy in proxies))


def check_nothing_is_lost_or_doubled(site: LoadedSite, study: Study, outcome: Outcome) -> None:
    """Compare what was acknowledged with the database and with the exported tables."""
    db = site.open()
    collected = {one.row.completion_code: one for one in collection.collect(db, study)}
    tables = export.tables(db, study)
    db.close()
    trials = len(study.definition.every_clip)
    for told in outcome.stored:
        person = collected[told.code]
        events = [event for one in person.trials for event in one.events]
        keys = Counter(event.key for event in events)
        assert set(told.entries) <= set(keys), "an acknowledged entry is lost"
        assert max(keys.values()) == 1, "an entry is doubled"
        assert sorted(told.forms) == list(range(1, trials + 1))
        for one in person.trials:
            final = [event for event in one.events if event.payload.get("is_final")]
            assert len(final) == 1, "a questionnaire is stored twice"
        name = person.row.public_id
        check_tables(tables, name, told.forms, trials=trials)
    # Nobody was enrolled twice: everyone who is there came to the end.
    assert list(tables.participants["status"]) == ["completed"] * len(outcome.stored)


def check_tables(
    tables: export.Tables, name: str, forms: dict[int, dict[str, str]], *, trials: int
) -> None:
    """Find exactly the acknowledged values of one person in the exported tables."""
    rows: Any = tables.comparisons[tables.comparisons["participant"] == name]
    assert len(rows) == trials
    for _, row in rows.iterrows():
        told = forms[int(str(row["trial"]).rpartition("-")[2])]
        assert {key: str(row[key]) for key in ("comparison", "what_differed", "comments")} == {
            key: told[key] for key in ("comparison", "what_differed", "comments")
        }
    ratings: Any = tables.ratings[tables.ratings["participant"] == name]
    assert len(ratings) == 2 * trials
    for _, row in ratings.iterrows():
        told = forms[int(str(row["trial"]).rpartition("-")[2])]
        assert str(row["rating"]) == told[f"rating_{row['eye']}"]


def test_nothing_is_lost_or_doubled_in_a_short_storm(
    site: LoadedSite, capsys: pytest.CaptureFixture[str]
) -> None:
    study = site.prepare()
    kills = ("consent", "answer", "questionnaire", "form")
    outcome = asyncio.run(live_through(site, study, people=6, share=0.3, kills=kills, seed=5))
    check_nothing_is_lost_or_doubled(site, study, outcome)
    with capsys.disabled():
        print(f"\n  chaos: {outcome}")
    assert outcome.kills == len(kills)
    assert {what for what, _ in outcome.seen} >= {*CUTS, "doubled", "at once", "reload"}


@pytest.mark.long
@pytest.mark.parametrize("seed", range(5))
def test_nothing_is_lost_or_doubled_in_long_storms(
    site: LoadedSite, seed: int, capsys: pytest.CaptureFixture[str]
) -> None:
    study = site.prepare()
    kills = STEPS * 4
    outcome = asyncio.run(live_through(site, study, people=25, share=0.5, kills=kills, seed=seed))
    check_nothing_is_lost_or_doubled(site, study, outcome)
    with capsys.disabled():
        print(f"\n  chaos, seed {seed}: {outcome}")
    assert outcome.kills == len(kills)
    assert {(what, kind) for what in CUTS for kind in STEPS} <= set(outcome.seen)
