"""A site on a real port, and what a test needs to look behind it."""

from __future__ import annotations

import socket
import threading
from dataclasses import dataclass

import uvicorn
from guests import Guest
from small_study import FRAMES

from study.data import export, jobs, participants, studies
from study.data.database import Database
from study.settings import Settings
from study.site.app import create_app
from study.site.signatures import simulation_token


@dataclass
class Site:
    """A running site and what a test needs to look behind it."""

    url: str
    db: Database
    study: studies.Study
    settings: Settings

    @property
    def by_name(self) -> str:
        """The same site under a host name: to browsers no secure context."""
        return self.url.replace("127.0.0.1", "study.test")

    def guest(self, **headers: str) -> Guest:
        """Return a browser that nobody has used."""
        return Guest(self.url, **headers)

    def people(self) -> list[participants.Participant]:
        """Return everybody who takes part, in order of arrival."""
        names = export.tables(self.db, self.study).participants["participant"]
        found = [participants.by_public_id(self.db, self.study, name) for name in names]
        return [person for person in found if person is not None]

    @property
    def simulation(self) -> dict[str, str]:
        """The header that proves a simulated participant."""
        return {"X-Ocularist-Simulation": simulation_token(self.settings.secret_key())}


class Serving:
    """Serve a site until the block ends. Its socket listens at once, so nobody has to wait."""

    def __init__(self, settings: Settings, study: studies.Study) -> None:
        self.socket = socket.create_server(("127.0.0.1", 0))
        app = create_app(settings, study_id=study.id)
        self.server = uvicorn.Server(
            uvicorn.Config(app, log_level="critical", access_log=False, lifespan="on")
        )
        self.thread = threading.Thread(
            target=self.server.run, kwargs={"sockets": [self.socket]}, daemon=True
        )

    def __enter__(self) -> str:
        self.thread.start()
        return f"http://127.0.0.1:{self.socket.getsockname()[1]}"

    def __exit__(self, *_: object) -> None:
        self.server.should_exit = True
        self.thread.join(10)
        self.socket.close()


def finish_jobs(db: Database) -> None:
    """Mark every queued clip as rendered."""
    while (job := jobs.claim(db, worker="test")) is not None:
        jobs.finish(db, job, worker="test", record={"frame_count": FRAMES})
