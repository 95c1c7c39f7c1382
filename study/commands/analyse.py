"""``ocularist analyse``: figures, tables and a report from anyone's ratings.

From files it needs neither web framework nor database nor GL; only a database loads the one.
"""

from __future__ import annotations

import argparse
import gc
import os
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

from study.commands.places import new_folder
from study.commands.values import number

if TYPE_CHECKING:
    from analysis import Tables

HELP = "write figures, tables and a report"
DESCRIPTION = (
    "Analyse ratings: charts as SVG and PNG, the numbers behind each as CSV, and one report that "
    "stands on its own. Any table with the columns participant, lod and rating will do."
)
EXAMPLE = "tables --bench bench.json --out report"
SQLITE: Final = b"SQLite format 3\0"  # how a database's file begins (sqlite.org/fileformat)
WIDTH: Final = 96


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument(
        "source",
        metavar="SOURCE",
        help="a ratings file, the folder of an export, or a database: its URL, file or data folder "
        "(its newest study)",
    )
    parser.add_argument(
        "--out",
        type=new_folder,
        default="out/report",
        metavar="DIR",
        help="folder for what is written (default: %(default)s)",
    )
    parser.add_argument(
        "--bench", type=Path, metavar="FILE.json", help="costs measured by ocularist bench"
    )
    parser.add_argument(
        "--realism-margin",
        type=number,
        metavar="POINTS",
        help="a loss of realism that does not matter (default: what the study declared, else 0.5)",
    )
    parser.add_argument(
        "--noticed-margin",
        type=number,
        metavar="SHARE",
        help="share of people, beyond false alarms, who may notice (default: what the study "
        "declared, else 0.25)",
    )
    parser.add_argument(
        "--confidence",
        type=number,
        metavar="SHARE",
        help="confidence of each bound, one-sided (default: what the study declared, else 0.95)",
    )
    parser.add_argument(
        "--codes",
        type=Path,
        metavar="FILE.csv",
        help="remarks coded by hand: a report's remark-codes.csv, corrected",
    )


def run(options: argparse.Namespace) -> int:
    """Analyse, say the answer, name the report."""
    with _uncollected():
        return _run(options)


@contextmanager
def _uncollected() -> Iterator[None]:
    """Look for no cycles of dead objects meanwhile.

    Each search walks all that the libraries made: 0.2 to 0.3 s, in every process that draws. Only
    figures leave cycles, a few MB each.
    """
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()


def _run(options: argparse.Namespace) -> int:
    from analysis import Margins, analyse, read_source

    asked = {
        "realism_points": options.realism_margin,
        "noticed_share": options.noticed_margin,
        "confidence": options.confidence,
    }
    Margins().changed(**asked)  # refuses what cannot be before anything is read
    source = source_of(options.source)
    tables = _from_database(source) if "://" in source else read_source(source)
    margins = tables.margins.changed(**asked)
    summary = analyse(
        tables,
        options.out,
        bench=options.bench,
        codes=options.codes,
        margins=margins,
        processes=min(2, os.cpu_count() or 1),
    )
    for line in summary.lines():
        print("\n".join(textwrap.wrap(line, WIDTH, break_on_hyphens=False)))
    print(summary.report)
    return 0


def source_of(source: str) -> str:
    """Return the URL of a database named by its file or data folder; else the source as it is."""
    path = Path(source)
    if path.is_dir() and not (path / "ratings.csv").exists():
        path = path / "study.sqlite3"
    if not path.is_file():
        return source
    with path.open("rb") as file:
        return f"sqlite:///{path}" if file.read(len(SQLITE)) == SQLITE else source


def _from_database(url: str) -> Tables:
    from analysis import tables_from
    from study.commands.preparing import find_study, open_existing
    from study.data import export
    from study.settings import Settings

    db = open_existing(Settings(database_url=url))
    try:
        study = find_study(db, None)
        found = export.tables(db, study)
    finally:
        db.close()
    frames = {
        "ratings": found.ratings,
        "comparisons": found.comparisons,
        "participants": found.participants,
    }
    return tables_from(frames, source=study.key, codebook=found.codebook)
