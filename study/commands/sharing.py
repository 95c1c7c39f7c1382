"""Several server processes at one address, each with a socket of its own.

Of processes that share one socket whichever is idle first takes whoever waits: the first that is up
took a whole crowd. Linux spreads new connections over sockets that share an address (SO_REUSEPORT).
"""

from __future__ import annotations

import socket
import sys
from typing import Final

from uvicorn import Config
from uvicorn.supervisors.multiprocess import Multiprocess, Process

CAN_SPREAD: Final = sys.platform == "linux"
"""Elsewhere the option means something else, and the processes share one socket."""


def serve_together(config: Config) -> None:
    """Serve with ``config.workers`` processes until told to stop."""
    count = config.workers if CAN_SPREAD else 1
    _Together(config, sockets=[_bound(config) for _ in range(count)]).run()


class _Together(Multiprocess):
    """Processes of which each begins with its own socket.

    One that takes another's place gets all of them: nobody waits in vain at the socket of the dead.
    """

    def init_processes(self) -> None:
        for number in range(self.processes_num):
            process = Process(self.config, [self.sockets[number % len(self.sockets)]])
            process.start()
            self.processes.append(process)


def _bound(config: Config) -> socket.socket:
    family = socket.AF_INET6 if ":" in config.host else socket.AF_INET
    made = socket.socket(family=family)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    if CAN_SPREAD:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
    made.bind((config.host, config.port))
    made.set_inheritable(True)
    return made
