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
    # The number may belong to another process by now.
    return _started(int(parts[1])) != parts[2]


def _started(pid: int) -> str:
    """Return when a process started, in the kernel's ticks; empty where that cannot be known."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
    # Field 22 (proc(5)), counted behind the name in brackets, which may hold spaces.
    return stat.rpartition(")")[2].split()[19]
