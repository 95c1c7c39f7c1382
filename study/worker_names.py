"""What a worker is called: a name that tells others on its machine whether it is still alive."""

from __future__ import annotations

import os
import secrets
import socket
from pathlib import Path


def worker_name() -> str:
    """Return a name that tells others where this worker runs: host, process, its start, a tag."""
    pid = os.getpid()
    return f"{socket.gethostname()[:60]}|{pid}|{_started(pid)}|{secrets.token_hex(4)}"


def is_dead(worker: str) -> bool:
    """Say whether a worker's process on this machine is gone; False for other machines."""
    parts = worker.split("|")
    if len(parts) != 4 or parts[0] != socket.gethostname()[:60] or not parts[1].isdecimal():
        return False
    try:
        os.kill(int(parts[1]), 0)
    except ProcessLookupError:
        return True
    except PermissionError:
        return False
    # The number may belong to another process by now, or to one that ended and was not waited for.
    return _started(int(parts[1])) != parts[2] or _is_ended(int(parts[1]))


def _started(pid: int) -> str:
    """Return when a process started, in the kernel's ticks; empty where that cannot be known."""
    # Field 22 of proc(5), counted from the third.
    stat = _stat(pid)
    return stat[19] if stat else ""


def _is_ended(pid: int) -> bool:
    """Say whether a process has ended although its number is still taken."""
    return _stat(pid)[:1] in (["Z"], ["X"])


def _stat(pid: int) -> list[str]:
    """Return proc(5)'s fields of a process from the third on; empty where there are none."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return []
    return stat.rpartition(")")[2].split()  # the name in brackets may hold spaces
