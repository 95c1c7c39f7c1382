"""``ocularist analyse``: figures, tables and a report from anyone's ratings.

From files it needs neither web framework nor database nor GL; only a database's URL loads the one.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from analysis.reading import Tables

HELP = "write figures, tables and a report"
DESCRIPTION = (
    "Analyse ratings: charts as SVG and PNG, the numbers behind each as CSV, and one report that "
    "stands on its own. Any table with the columns participant, lod and rating will do."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument(
        "source",
        metavar="SOURCE",
        help="a ratings file, the folder of an export, or a database's URL (its newest study)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("out/report"),
        metavar="DIR",
        help="folder for what is written (default: %(default)s)",
    )
    parser.add_argument(
        "--bench", type=Path, metavar="FILE.json", help="costs measured by ocularist bench"
    )


def run(options: argparse.Namespace) -> int:
    """Analyse and name the report."""
    from analysis.report import write_report

    tables = _from_database(options.source) if "://" in options.source else None
    if tables is None:
        from analysis.reading import read_source

        tables = read_source(options.source)
    report = write_report(tables, options.out, bench=options.bench)
    print(report)
    return 0


def _from_database(url: str) -> Tables:
    from analysis.reading import tables_from
    from study.commands.preparing import find_study, open_existing
    from study.data import export
    from study.settings import Settings

    db = open_existing(Settings(database_url=url))
    try:
        found = export.tables(db, find_study(db, None))
    finally:
        db.close()
    frames = {
        "ratings": found.ratings,
        "comparisons": found.comparisons,
        "participants": found.participants,
    }
    return tables_from(frames, source=url, codebook=found.codebook)
