"""``ocularist serve``: the site alone, on a machine that needs no GL."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from typing import TYPE_CHECKING, Any, Final

from study.commands.errors import CommandError
from study.commands.options import add_listening, add_places, add_study, settings_of
from study.commands.values import count

if TYPE_CHECKING:
    from fastapi import FastAPI

    from study.settings import Settings
    from study.site.place import Place

HELP = "run the site alone"
DESCRIPTION = (
    "Run the participants' and the researchers' pages. Clips are rendered elsewhere: by ocularist "
    "worker on the same database and clips' folder, or beforehand by ocularist render."
)
EXAMPLE = "thesis --host 0.0.0.0 --tls-cert cert.pem --tls-key key.pem"
SITE: Final = "study.commands.serve:site_of_environment"
GRACE_S: Final = 5  # for answers on their way when the site is told to stop
STUDY_ID: Final = "OCULARIST_STUDY_ID"
"""Tells the site's processes which study newcomers take part in."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    add_places(parser)
    add_listening(parser)
    parser.add_argument(
        "--processes",
        type=count,
        default=1,
        metavar="N",
        help="server processes, on PostgreSQL (default: 1)",
    )
    parser.add_argument("--quiet", action="store_true", help="do not print the addresses")


def run(options: argparse.Namespace) -> int:
    """Serve until stopped by Ctrl-C or SIGTERM."""
    import uvicorn

    from study.commands.listening import check_certificate, check_port, welcome
    from study.commands.preparing import prepare
    from study.commands.researcher import add_first
    from study.commands.sharing import serve_together

    settings = settings_of(options)
    _check_processes(settings, options.processes)
    check_port(settings)
    check_certificate(settings)
    prepared = prepare(settings, options.study)
    password = add_first(prepared.db)
    prepared.db.close()  # the site opens its own
    settings.secret_key()  # made before several processes ask for it
    if not options.quiet:
        print("\n".join(welcome(settings, prepared.study.title, password)), flush=True)
    os.environ |= {**_environment(settings), STUDY_ID: str(prepared.study.id)}
    how: dict[str, Any] = {
        "factory": True,
        "workers": options.processes,
        "host": settings.host,
        "port": settings.port,
        "log_level": "warning",
        "access_log": False,
        "server_header": False,
        "timeout_graceful_shutdown": GRACE_S,
        "ssl_certfile": settings.tls_cert,
        "ssl_keyfile": settings.tls_key,
    }
    if options.processes > 1:
        serve_together(uvicorn.Config(SITE, **how))
    else:
        uvicorn.run(SITE, **how)
    return 0


def _check_processes(settings: Settings, processes: int) -> None:
    """Refuse several processes on SQLite: one of them writes, and the others would only wait."""
    if processes > 1 and not settings.database_url.startswith("postgres"):
        raise CommandError(
            f"--processes {processes} needs PostgreSQL; SQLite is written by one process at a time "
            "(--database postgresql://host/name, or leave out --processes)"
        )


def _environment(settings: Settings) -> dict[str, str]:
    return {
        "OCULARIST_DATA": str(settings.data_folder),
        "OCULARIST_DATABASE": settings.database_url,
        "OCULARIST_MEDIA": str(settings.media_folder),
    }


def site_of_environment() -> FastAPI:
    """Build the site in a server process, from what ``run`` left in the environment."""
    from study.settings import read_settings
    from study.site.app import create_app

    site = create_app(read_settings(os.environ), study_id=int(os.environ[STUDY_ID]))
    place: Place = site.state.place
    place.warm_up()
    _tune_interpreter()
    return site


def _tune_interpreter() -> None:
    """Leave out of every search for garbage what stays as long as the process; switch sooner.

    A thread that comes back from the disk waits for the one that answers pages, by default 5 ms.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 50)
    sys.setswitchinterval(0.001)
