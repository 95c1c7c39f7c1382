"""Start ``ocularist`` itself as a process of its own: the site, the renderer."""

from __future__ import annotations

import contextlib
import ctypes
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from study.settings import Settings

FIGURE_NICENESS: Final = 10  # on top of the worker's own: clips come before figures
_PR_SET_PDEATHSIG: Final = 1  # linux/prctl.h


def start_serving(settings: Settings, study: str) -> subprocess.Popen[bytes]:
    """Start the site, where the settings say."""
    arguments = ["serve", study, "--quiet", *_places(settings)]
    arguments += ["--host", settings.host, "--port", str(settings.port)]
    if settings.tls_cert and settings.tls_key:
        arguments += ["--tls-cert", str(settings.tls_cert), "--tls-key", str(settings.tls_key)]
    return start_command(arguments, environment=_secrets(settings))


def start_rendering(settings: Settings, *, niceness: int) -> subprocess.Popen[bytes]:
    """Start a worker; the higher its niceness, the more others come first."""
    return start_command(
        ["worker", *_places(settings)], environment=_secrets(settings), niceness=niceness
    )


def start_drawing(settings: Settings, claimed_by: str) -> subprocess.Popen[bytes]:
    """Start the drawing of the figures that a worker of that name has claimed, behind all else."""
    return start_command(
        [
            "figures",
            "--claimed-by",
            claimed_by,
            *_places(settings),
            "--bench",
            str(settings.bench_file),
        ],
        environment={**_secrets(settings), "OPENBLAS_NUM_THREADS": "1"},
        niceness=FIGURE_NICENESS,
    )


def _places(settings: Settings) -> list[str]:
    return ["--data", str(settings.data_folder), "--media", str(settings.media_folder)]


def _secrets(settings: Settings) -> dict[str, str]:
    # A database's URL may hold a password, so it is no argument.
    return {"OCULARIST_DATABASE": settings.database_url}


def start_command(
    arguments: Sequence[str],
    *,
    environment: Mapping[str, str] | None = None,
    niceness: int = 0,
) -> subprocess.Popen[bytes]:
    """Start ``ocularist`` with these arguments as a process of its own.

    ``environment`` adds to ours; secrets go there, because everybody can read arguments. The
    process lives in its own session, so that Ctrl-C reaches its keeper alone, and ends with its
    keeper even if that is killed.
    """
    nice = ["nice", "-n", str(niceness)] if niceness else []
    return subprocess.Popen(
        [*nice, *ending_with_parent(), sys.executable, "-m", "study", *arguments],
        stdin=subprocess.DEVNULL,
        env={**os.environ, **(environment or {})},
        start_new_session=True,
    )


def ending_with_parent() -> list[str]:
    """Return what stands before a command whose process ends when its parent dies; Linux alone."""
    program = shutil.which("setpriv")
    if program is None:
        return []
    # A parent that died before the child could ask is no longer the child's parent.
    still_there = '[ "$PPID" = "$0" ] && exec "$@"'
    return [program, "--pdeathsig", "TERM", "--", "sh", "-c", still_there, str(os.getpid())]


def end_with_parent() -> None:
    """Have this process sent SIGTERM when its parent dies; Linux alone can."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
