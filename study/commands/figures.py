"""``ocularist figures``: draw the dashboard's figures where answers have come.

A worker starts this by itself; by hand it serves where no worker runs.
"""

from __future__ import annotations

import argparse

from study.commands.options import add_costs, add_places, settings_of

HELP = "draw the dashboard's figures"
DESCRIPTION = (
    "Draw the figures and the report that the dashboard shows, where answers have come since and "
    "a researcher has switched the results on. A worker does this by itself, at most once a "
    "minute; use this command where none runs."
)
EXAMPLE = "--data ocularist-data"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_places(parser)
    add_costs(parser)
    parser.add_argument("--claimed-by", metavar="NAME", help=argparse.SUPPRESS)


def run(options: argparse.Namespace) -> int:
    """Draw what is due, or what the worker of that name has claimed."""
    from study.commands.preparing import open_existing
    from study.data import figures
    from study.figures import draw_claimed
    from study.worker_names import is_dead, worker_name

    settings = settings_of(options)
    if options.bench is not None:
        options.bench.open("rb").close()  # said now, not with the first figures
    db = open_existing(settings)
    try:
        if options.claimed_by:
            draw_claimed(db, worker=options.claimed_by, bench=settings.bench_file)
            return 0
        figures.free_dead(db, is_dead)
        name, drawn = worker_name(), 0
        while figures.claim(db, worker=name) is not None:
            drawn += draw_claimed(db, worker=name, bench=settings.bench_file)
    finally:
        db.close()
    print(_told(drawn))
    return 0


def _told(drawn: int) -> str:
    if drawn == 0:
        return "nothing to draw: no new answers, or nobody has the results switched on"
    return f"{drawn} sets of figures drawn" if drawn != 1 else "1 set of figures drawn"
