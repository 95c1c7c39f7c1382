"""``ocularist load``: how many people at once a site stands, measured on this machine."""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING, Final

from study.commands.errors import CommandError
from study.commands.options import count
from study.commands.places import new_file

if TYPE_CHECKING:
    from study.load.runs import Run

HELP = "measure a site under many simulated people"
DESCRIPTION = (
    "Start a site of its own in a temporary folder, let simulated people answer at it without "
    "pauses, and print answers per second, response times and the cost of fsync: on SQLite with "
    "one process and on PostgreSQL with several. What was acknowledged is compared with what is "
    "stored when the site has been killed at the end. Nothing of your own data is touched."
)
DATABASES: Final = ("sqlite", "postgresql", "both")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument("--people", type=count, default=200, help="at once (default: 200)")
    parser.add_argument("--seconds", type=count, default=20, help="per run (default: 20)")
    parser.add_argument(
        "--pause",
        type=float,
        default=0.0,
        metavar="S",
        help="mean seconds between two requests of one person (default: none)",
    )
    parser.add_argument("--database", choices=DATABASES, default="both")
    parser.add_argument(
        "--processes", type=count, default=2, help="server processes on PostgreSQL (default: 2)"
    )
    parser.add_argument(
        "--no-fsync-cost", action="store_true", help="leave out the runs without fsync"
    )
    parser.add_argument(
        "--out", type=new_file, metavar="FILE", help="write the figures as JSON too"
    )


def run(options: argparse.Namespace) -> int:
    """Measure and print."""
    import asyncio

    from study.load.postgresql import NoServerError
    from study.load.report import machine, table
    from study.load.runs import measure

    if options.pause < 0:
        raise CommandError(f"--pause {options.pause:g}: a pause lasts 0 s or longer")
    found = []
    print(machine(), flush=True)
    for one in _runs(options):
        if sys.stderr.isatty():
            print(f"{one.database}, fsync {'on' if one.fsync else 'off'} ...", file=sys.stderr)
        try:
            found.append(asyncio.run(measure(one)))
        except NoServerError as error:
            raise CommandError(str(error)) from None
    print(table(found))
    if options.out:
        options.out.write_text(json.dumps([figures.plain() for figures in found], indent=2) + "\n")
    return 1 if any(figures.errors or figures.lost for figures in found) else 0


def _runs(options: argparse.Namespace) -> list[Run]:
    from study.load.runs import POSTGRESQL, SQLITE, Run

    kinds = (SQLITE, POSTGRESQL) if options.database == "both" else (options.database,)
    return [
        Run(
            kind,
            processes=options.processes if kind == POSTGRESQL else 1,
            people=options.people,
            seconds=options.seconds,
            pause_s=options.pause,
            fsync=fsync,
        )
        for kind in kinds
        for fsync in ((True,) if options.no_fsync_cost else (True, False))
    ]
