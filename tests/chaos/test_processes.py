"""Several server processes on one PostgreSQL database know the same people, forms and limits."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from study.data import collection, researchers
from study.load.person import Person
from study.load.site import LoadedSite
from study.load.wire import Wire

PEOPLE = 2


@pytest.fixture
def site(tmp_path: Path, database_url: str) -> Iterator[LoadedSite]:
    one = LoadedSite(tmp_path, database_url, processes=2)
    yield one
    one.kill()


def workers_of(pid: int) -> int:
    """Count a process's children that serve."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    lines = [Path(f"/proc/{child}/cmdline").read_bytes() for child in children]
    return sum(b"spawn_main" in line for line in lines)


async def guess(url: str) -> list[int]:
    """Try wrong passwords, each over a connection of its own, so that both processes hear some."""
    found = []
    for _ in range(7):
        wire = Wire(url)
        fields = {"name": "ada", "password": "not this one"}
        found.append((await wire.post_form("/researcher/sign-in", fields)).status)
        wire.close()
    return found


@pytest.mark.parametrize("database_kind", ["postgresql"])
def test_people_walk_through_two_processes_and_guessers_find_one_limit(site: LoadedSite) -> None:
    study = site.prepare()
    db = site.open()
    researchers.add(db, "ada", "correct horse battery")

    async def live() -> tuple[list[str], list[int]]:
        site.start()
        await site.wait()

        async def one(number: int) -> str:
            person = Person(
                Wire(site.url), np.random.default_rng(number), definition=study.definition
            )
            # A new connection per page: whichever process takes it has to know the person.
            keep = person.wire.request

            async def request(*args: object, **kwargs: object) -> object:
                person.wire.close()
                return await keep(*args, **kwargs)

            person.wire.request = request
            person.uses_outbox = False
            return (await person.walk()).code

        codes = await asyncio.gather(*(one(number) for number in range(PEOPLE)))
        return list(codes), await guess(site.url)

    codes, guesses = asyncio.run(live())
    assert site.process is not None
    assert workers_of(site.process.pid) == 2
    assert guesses == [401] * 5 + [429] * 2
    stored = {one.row.completion_code for one in collection.collect(db, study)}
    db.close()
    assert set(codes) == stored
    assert all(re.fullmatch(r"[A-Z0-9]{4}-[A-Z0-9]{4}", code) for code in codes)


@pytest.mark.parametrize("database_kind", ["sqlite"])
def test_several_processes_on_sqlite_are_refused_with_the_reason(site: LoadedSite) -> None:
    site.prepare()
    site.start()
    assert site.process is not None
    assert site.process.wait(60) == 1
    assert (
        "ocularist serve: --processes 2 needs PostgreSQL; SQLite is written by one process at a "
        "time" in site.last_words
    )
