"""A site of one's own to load: a real server process on a real port, with clips that show nothing.

It lives in a folder of its own and is gone afterwards. It can be killed and started again.
"""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from renderer.clip import ClipSpec
from renderer.manifest import ClipRecord, Manifest, write_manifest
from renderer.sources import code_version
from study.commands.starting import ending_with_parent
from study.data import jobs, studies
from study.data.database import Database, open_database
from study.data.studies import Study
from study.design.definition import StudyDefinition, read_definition
from study.settings import Settings

UP_S: Final = 120.0
LISTEN: Final = "0A"  # TCP_LISTEN in include/net/tcp_states.h
NAME: Final = "load"
PROGRAM: Final = ("-m", "study")


class SiteError(RuntimeError):
    """The site under load did not start; the message shows its last words."""


@dataclass
class LoadedSite:
    """A site under ``folder`` on a database, from ``prepare`` to ``close``."""

    folder: Path
    database_url: str
    study_name: str = "thesis"
    processes: int = 1
    environment: Mapping[str, str] = field(default_factory=dict)
    program: tuple[str, ...] = PROGRAM
    port: int = 0
    process: subprocess.Popen[bytes] | None = None

    def prepare(self) -> Study:
        """Put study and clips there."""
        definition = read_definition(self.study_name)
        put_stand_ins(definition, self.media_folder)
        db = self.open()
        try:
            study = studies.register(db, definition)
            jobs.enqueue(db, definition.wanted_specs())
            with db.writing():
                while (job := jobs.claim(db, worker=NAME)) is not None:
                    jobs.finish(db, job, worker=NAME, record={"frame_count": 1})
        finally:
            db.close()
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = free.getsockname()[1]
        return study

    def open(self) -> Database:
        """Open the site's database, to look behind it."""
        return open_database(self.database_url)

    @property
    def media_folder(self) -> Path:
        """Where the clips are."""
        return self.folder / "clips"

    @property
    def url(self) -> str:
        """The site's address."""
        return f"http://127.0.0.1:{self.port}"

    @property
    def settings(self) -> Settings:
        """What the site is told."""
        return Settings(
            data_folder=self.folder, database_url=self.database_url, media_folder=self.media_folder
        )

    def start(self) -> None:
        """Start the server process; ``wait`` returns once it answers."""
        arguments = ["serve", self.study_name, "--quiet", "--port", str(self.port)]
        arguments += ["--data", str(self.folder), "--media", str(self.media_folder)]
        if self.processes > 1:
            arguments += ["--processes", str(self.processes)]
        with (self.folder / "log").open("ab") as log:
            self.process = subprocess.Popen(
                [*ending_with_parent(), sys.executable, *self.program, *arguments],
                env={**os.environ, **self.environment, "OCULARIST_DATABASE": self.database_url},
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )

    async def wait(self) -> None:
        """Wait until every process of the site listens.

        Raises SiteError if it ends or takes too long.
        """
        deadline = time.monotonic() + UP_S
        while listening(self.port) < self.processes:
            if self.process is None or self.process.poll() is not None:
                raise SiteError(f"the site did not start: {self.last_words}")
            if time.monotonic() > deadline:
                raise SiteError(f"the site took over {UP_S:g} s to start")
            await asyncio.sleep(0.05)

    def kill(self) -> None:
        """Kill the server, and its processes with it, as a power cut would."""
        if self.process is not None:
            with contextlib.suppress(ProcessLookupError):  # it had ended by itself
                os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
            self.process = None

    @property
    def last_words(self) -> str:
        """The end of what the server printed."""
        log = self.folder / "log"
        return log.read_text(errors="replace")[-2000:] if log.exists() else ""


def listening(port: int) -> int:
    """Count the sockets that listen at a port of this machine, from /proc (proc(5), net/tcp).

    Each process of a site has its own; a connection would say that one of them is there.
    """
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    return sum(row[3] == LISTEN and int(row[1].split(":")[1], 16) == port for row in rows)


def put_stand_ins(definition: StudyDefinition, folder: Path) -> None:
    """Put a few bytes for every clip of a study on a shelf, with their manifest."""
    folder.mkdir(parents=True, exist_ok=True)
    manifest = Manifest()
    for wanted in definition.wanted_specs():
        data = f"no film, {wanted.spec.clip_id}".encode()
        (folder / f"{wanted.spec.clip_id}.mp4").write_bytes(data)
        manifest.add(_record(wanted.spec, data))
    write_manifest(manifest, folder)


def _record(spec: ClipSpec, data: bytes) -> ClipRecord:
    return ClipRecord(
        clip_id=spec.clip_id,
        spec=spec.to_dict(),
        file=f"{spec.clip_id}.mp4",
        file_sha256=hashlib.sha256(data).hexdigest(),
        file_bytes=len(data),
        raw_sha256="0" * 64,
        frame_count=spec.frame_count,
        width=spec.width,
        height=spec.height,
        fps=spec.fps,
        iris_px=[[40.0, 40.0]],
        visible_px=[[900, 900]],
        psnr_db=[],
        ssim=[],
        frame_ms_median=0.0,
        render_s=0.0,
        gl_renderer="none: a stand-in",
        gl_version="none",
        code_version=code_version(),
    )
