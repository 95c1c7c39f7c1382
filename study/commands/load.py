"""``ocularist load``: how many people at once a site stands, measured on this machine."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from study.commands.errors import CommandError
from study.commands.places import new_file
from study.commands.values import count, number

if TYPE_CHECKING:
    from study.load.report import Figures
    from study.load.runs import Run

HELP = "measure a site under many simulated people"
DESCRIPTION = (
    "Start a site of its own in a temporary folder, let simulated people answer at it without "
    "pauses, and print answers per second, response times and the cost of fsync: on SQLite with "
    "one process and on PostgreSQL with several. What was acknowledged is compared with what is "
    "stored when the site has been killed at the end. Nothing of your own data is touched."
)
EXAMPLE = "--people 50 --database sqlite"
DATABASES: Final = ("sqlite", "postgresql", "both")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument(
        "--people", type=count, default=200, metavar="N", help="at once (default: 200)"
    )
    parser.add_argument(
        "--seconds", type=count, default=20, metavar="S", help="per run (default: 20)"
    )
    parser.add_argument(
        "--pause",
        type=number,
        default=0.0,
        metavar="S",
        help="mean seconds between two requests of one person (default: none)",
    )
    parser.add_argument(
        "--database", choices=DATABASES, default="both", help="which to measure (default: both)"
    )
    parser.add_argument(
        "--processes",
        type=count,
        default=2,
        metavar="N",
        help="server processes on PostgreSQL (default: 2)",
    )
    parser.add_argument(
        "--no-fsync-cost", action="store_true", help="leave out the runs without fsync"
    )
    parser.add_argument(
        "--find",
        action="store_true",
        help="find how many people, up to --people, are answered in time; takes several runs",
    )
    parser.add_argument(
        "--below",
        type=number,
        default=100.0,
        metavar="MS",
        help="what is in time for --find: p95 of all requests (default: 100)",
    )
    parser.add_argument(
        "--out", type=new_file, metavar="FILE", help="write the figures as JSON too"
    )


def run(options: argparse.Namespace) -> int:
    """Measure and print."""
    from study.load.postgresql import NoServerError
    from study.load.report import kinds_table, machine, table

    if options.pause < 0:
        raise CommandError(f"--pause {options.pause:g}: a pause lasts 0 s or longer")
    if not options.below > 0:
        raise CommandError(f"--below {options.below:g}: a time is longer than 0 ms")
    found: list[Figures] = []
    said: list[str] = []
    print(machine(), flush=True)
    for one in _runs(options):
        try:
            said += _find(one, found, below_ms=options.below) if options.find else []
            found += [] if options.find else [_measured(one)]
        except NoServerError as error:
            raise CommandError(str(error)) from None
    print("\n".join([table(found), "", kinds_table(found), *said]))
    if options.out:
        options.out.write_text(json.dumps([figures.plain() for figures in found], indent=2) + "\n")
    # A crowd that is too large is what --find looks for; a lost answer is never right.
    return 1 if any(one.lost or (one.errors and not options.find) for one in found) else 0


def _measured(one: Run) -> Figures:
    import asyncio

    from study.load.runs import measure

    if sys.stderr.isatty():
        how = f"fsync {'on' if one.fsync else 'off'}, {one.people} people"
        print(f"{one.database}, {how} ...", file=sys.stderr)
    return asyncio.run(measure(one))


def _find(one: Run, found: list[Figures], *, below_ms: float) -> list[str]:
    """Measure crowd after crowd, which join ``found``; returns what came of it in a sentence."""
    from study.load.find import largest

    def measured(people: int) -> Figures:
        found.append(_measured(replace(one, people=people)))
        return found[-1]

    carried = largest(measured, below_ms=below_ms, most=one.people)
    more = ", or more" if carried == one.people else ""
    pauses = f"with pauses of {one.pause_s:g} s" if one.pause_s else "without pauses"
    return [
        f"{one.database} x {one.processes}: {carried} people{more} at once {pauses} "
        f"(p95 below {below_ms:g} ms)"
    ]


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
        for fsync in ((True,) if options.no_fsync_cost or options.find else (True, False))
    ]
