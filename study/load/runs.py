"""Load runs: a site of one's own on a database of one's own, a crowd, and what came of it."""

from __future__ import annotations

import contextlib
import subprocess
import tempfile
from collections.abc import AsyncIterator, Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from study.data import collection
from study.data.studies import Study
from study.load.crowd import Crowd
from study.load.postgresql import TemporaryServer
from study.load.report import Figures, figures_of
from study.load.site import PROGRAM, LoadedSite
from study.site.signatures import SIMULATION_HEADER, simulation_token

SQLITE: Final = "sqlite"
POSTGRESQL: Final = "postgresql"
MEMORY: Final = Path("/dev/shm")


@dataclass(frozen=True)
class Run:
    """What to measure. ``fsync`` False puts the database where the disk is never waited for."""

    database: str
    processes: int
    people: int
    seconds: float
    pause_s: float = 0.0
    fsync: bool = True
    uses_outbox: bool = True
    study: str = "thesis"
    program: tuple[str, ...] = PROGRAM


@dataclass(frozen=True)
class Running:
    """A site under load: where it is, what is asked there, and the programs that are its own."""

    site: LoadedSite
    study: Study
    servers: tuple[int, ...]

    def crowd(self, run: Run) -> Crowd:
        """Return a crowd that is about to come."""
        return Crowd(
            self.site.url,
            self.study.definition,
            people=run.people,
            seconds=run.seconds,
            pause_s=run.pause_s,
            uses_outbox=run.uses_outbox,
            headers={SIMULATION_HEADER: simulation_token(self.site.settings.secret_key())},
            servers=self.servers,
        )


@contextlib.asynccontextmanager
async def running(run: Run) -> AsyncIterator[Running]:
    """Start a site, which is killed at the end."""
    with _database(run) as (folder, url, server):
        site = LoadedSite(
            folder, url, study_name=run.study, processes=run.processes, program=run.program
        )
        study = site.prepare()
        site.start()
        try:
            await site.wait()
            programs = tuple(one.pid for one in (site.process, server) if one is not None)
            yield Running(site, study, programs)
        finally:
            site.kill()


async def measure(run: Run, *, report: Callable[[int], None] = lambda _done: None) -> Figures:
    """Start a site, let a crowd at it, compare what it acknowledged with what it stored."""
    async with running(run) as place:
        crowd = place.crowd(run)
        timings = await crowd.run(report)
        place.site.kill()
        return figures_of(
            timings,
            lost=_lost(place.site, place.study, crowd),
            database=run.database,
            processes=run.processes,
            fsync=run.fsync,
            people=run.people,
            there=timings.there,
            pause_s=run.pause_s,
            seconds=run.seconds,
        )


def _lost(site: LoadedSite, study: Study, crowd: Crowd) -> int:
    """Return how many acknowledged entries and questionnaires the killed site has not stored."""
    db = site.open()
    collected = collection.collect(db, study)
    db.close()
    trials = [one for person in collected for one in person.trials]
    keys = {event.key for one in trials for event in one.events}
    told = {key for one in crowd.stored for key in one.entries}
    complete = sum(one.trial.is_complete for one in trials)
    return len(told - keys) + max(0, sum(len(one.forms) for one in crowd.stored) - complete)


@contextlib.contextmanager
def _database(run: Run) -> Iterator[tuple[Path, str, subprocess.Popen[bytes] | None]]:
    """Give a folder for the site, the address of an empty database, and its server if it has one.

    Without fsync SQLite's file lies in memory, where a write to the disk costs nothing; the site
    itself has no switch for it.
    """
    parent = None if run.fsync or run.database != SQLITE else MEMORY
    with contextlib.ExitStack() as stack:
        name = stack.enter_context(tempfile.TemporaryDirectory(prefix="ocularist-", dir=parent))
        folder = Path(name)
        if run.database == SQLITE:
            yield folder, f"sqlite:///{folder}/study.sqlite3", None
            return
        more = ("max_connections=200", "shared_buffers=128MB", "synchronous_commit=on")
        server = stack.enter_context(TemporaryServer(is_durable=run.fsync, more=more))
        server.execute("CREATE DATABASE load")
        yield folder, server.url("load"), server.process
