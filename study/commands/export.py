"""``ocularist export``: a study's tables and their codebook, as files."""

from __future__ import annotations

import argparse

from study.commands.options import add_places, settings_of
from study.commands.places import new_folder

HELP = "write a study's tables and their codebook"
DESCRIPTION = (
    "Write ratings.csv, comparisons.csv, participants.csv, codebook.json and the study itself into "
    "a folder. Missing answers are empty cells. docs/tables.md explains every column."
)
EXAMPLE = "thesis --out tables"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument(
        "study",
        nargs="?",
        metavar="STUDY",
        help="a study of the database: its key or its file (default: the newest)",
    )
    parser.add_argument(
        "--out",
        type=new_folder,
        default="out/tables",
        metavar="DIR",
        help="folder for the files (default: %(default)s)",
    )
    add_places(parser)


def run(options: argparse.Namespace) -> int:
    """Write the files and name them."""
    from study.commands.preparing import find_study, open_existing
    from study.data import export

    db = open_existing(settings_of(options))
    try:
        study = find_study(db, options.study)
        for path in export.write(db, study, options.out):
            print(path)
    finally:
        db.close()
    return 0
