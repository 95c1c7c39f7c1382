"""A PostgreSQL server of one's own for a while: made in a temporary folder, gone afterwards.

It uses the programs of Debian's package ``postgresql``; nothing of a server that runs already is
touched. It listens on a socket in its folder alone, which only its owner can reach.
"""

from __future__ import annotations

import os
import pwd
import re
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal

from study.commands.starting import ending_with_parent

ACCOUNT: Final = "ocularist"
DEBIAN: Final = Path("/usr/lib/postgresql")
UNPRIVILEGED: Final = ("postgres", "nobody")
UP_S: Final = 120
STOP_S: Final = 30
MISSING: Final = (
    "PostgreSQL's server is not installed here (no initdb in /usr/lib/postgresql/*/bin or on the "
    "path); install it: apt-get install postgresql"
)


class NoServerError(RuntimeError):
    """A PostgreSQL server cannot be started; the message says why and what to do."""


@dataclass
class TemporaryServer:
    """A PostgreSQL server from ``with`` to the end of the block.

    ``is_durable`` False leaves out everything that only a power cut would need (fsync): quicker,
    and good for tests. ``more`` are further settings such as ``max_connections=300``.
    """

    is_durable: bool = False
    more: Sequence[str] = ()
    parent: Path | None = None
    folder: Path = field(init=False)
    process: subprocess.Popen[bytes] | None = None
    _programs: Path = field(init=False)

    def __enter__(self) -> TemporaryServer:
        self._programs = programs()
        self.folder = Path(tempfile.mkdtemp(prefix="ocularist-pg-", dir=self.parent))
        try:
            if (owner := _owner()) is not None:
                os.chown(self.folder, owner.pw_uid, owner.pw_gid)
            self._initialise()
            self.start()
        except BaseException:
            self._forget()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()
        self._forget()

    def start(self) -> None:
        """Start the server, which ends with this process at the latest; returns once it answers."""
        settings = [f"unix_socket_directories={self.folder}", "listen_addresses=", *self.more]
        if not self.is_durable:
            settings += ["fsync=off", "full_page_writes=off", "synchronous_commit=off"]
        options = [part for setting in settings for part in ("-c", setting)]
        with (self.folder / "log").open("ab") as log:
            self.process = subprocess.Popen(
                [*ending_with_parent(), self._programs / "postgres", "-D", self._data, *options],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,  # Ctrl-C reaches its keeper alone
                **self._account,
            )
        deadline = time.monotonic() + UP_S
        while not self._answers():
            if self.process.poll() is not None or time.monotonic() > deadline:
                self.stop("immediate")
                last = (self.folder / "log").read_text(errors="replace")[-500:]
                raise NoServerError(f"PostgreSQL did not start: {' '.join(last.split())}")
            time.sleep(0.05)

    def stop(self, mode: Literal["fast", "immediate"] = "fast") -> None:
        """Stop the server; "immediate" is what a crash is to it."""
        if self.process is None:
            return
        self.process.send_signal(signal.SIGINT if mode == "fast" else signal.SIGQUIT)
        try:
            self.process.wait(STOP_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.process = None

    def _answers(self) -> bool:
        import psycopg

        try:
            self.execute()
        except psycopg.OperationalError:
            return False
        return True

    def url(self, database: str = "postgres") -> str:
        """Return SQLAlchemy's address of one of its databases."""
        return f"postgresql+psycopg://{ACCOUNT}@/{database}?host={self.folder}"

    def execute(self, *statements: str) -> None:
        """Run statements outside of a transaction, such as CREATE DATABASE."""
        import psycopg

        where = f"host={self.folder} user={ACCOUNT} dbname=postgres"
        with psycopg.connect(where, autocommit=True) as connection:
            for statement in statements:
                connection.execute(statement.encode())

    @property
    def _data(self) -> str:
        return str(self.folder / "data")

    @property
    def _account(self) -> dict[str, Any]:
        """Whom to run as: PostgreSQL refuses to run as root."""
        owner = _owner()
        return {
            "cwd": self.folder,
            "env": {"PATH": os.environ.get("PATH", ""), "LC_ALL": "C"},
            **(
                {}
                if owner is None
                else {"user": owner.pw_uid, "group": owner.pw_gid, "extra_groups": []}
            ),
        }

    def _initialise(self) -> None:
        options = ["--auth", "trust", "--encoding", "UTF8", "--locale", "C", "--no-sync"]
        done = subprocess.run(
            [self._programs / "initdb", "-D", self._data, "--username", ACCOUNT, *options],
            capture_output=True,
            text=True,
            check=False,
            **self._account,
        )
        if done.returncode:
            said = " ".join((done.stdout + done.stderr).split())[-500:]
            raise NoServerError(f"PostgreSQL's initdb failed: {said}")

    def _forget(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)


def programs() -> Path:
    """Return the folder of the newest server's programs; raises NoServerError if there is none."""
    found = [path.parent for path in DEBIAN.glob("*/bin/initdb")]
    if found:
        return max(found, key=lambda path: [int(n) for n in re.findall(r"\d+", str(path))])
    on_path = shutil.which("initdb")
    if on_path is None:
        raise NoServerError(MISSING)
    return Path(on_path).resolve().parent


def _owner() -> pwd.struct_passwd | None:
    """Return the account that the server runs as, or None: ours, if we are not root."""
    if os.geteuid() != 0:
        return None
    known = {entry.pw_name: entry for entry in pwd.getpwall()}
    for name in UNPRIVILEGED:
        if name in known:
            return known[name]
    raise NoServerError(
        f"PostgreSQL refuses to run as root, and there is no account {UNPRIVILEGED}"
    )
