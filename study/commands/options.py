"""Options that several commands share, and how their texts are read.

A level is never read without its effect's or eye's name beside it, nor a distance without
``--distance``: the word "medium" alone could be either.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeVar

T = TypeVar("T")

DEFAULT_STUDY: Final = "thesis"
DATA_FOLDER: Final = Path("ocularist-data")


def add_study(parser: argparse.ArgumentParser) -> None:
    """Add the optional STUDY argument."""
    parser.add_argument(
        "study",
        nargs="?",
        default=DEFAULT_STUDY,
        metavar="STUDY",
        help="a built-in study (thesis, lod) or the path of a study file (default: %(default)s)",
    )


def add_database(parser: argparse.ArgumentParser) -> None:
    """Add --database and --media, the two places where a study's data lie."""
    parser.add_argument(
        "--database",
        metavar="URL",
        help="SQLAlchemy URL of the database, such as sqlite:///study.db or postgresql://host/name "
        f"(default: the SQLite file in {DATA_FOLDER}/)",
    )
    parser.add_argument(
        "--media",
        type=Path,
        metavar="DIR",
        help=f"folder of the clips and their manifest (default: {DATA_FOLDER}/clips)",
    )


def reading(read: Callable[[str], T]) -> Callable[[str], T]:
    """Let argparse show the message of a reader's ValueError instead of a general one."""

    def convert(text: str) -> T:
        try:
            return read(text)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return convert


@reading
def size(text: str) -> tuple[int, int]:
    """Read ``1280x720`` as width and height in pixels."""
    match = re.fullmatch(r"(\d{2,5})x(\d{2,5})", text.strip())
    if not match:
        raise ValueError(f'"{text}" is no size; write width x height in pixels, like 1280x720')
    return int(match[1]), int(match[2])


@reading
def count(text: str) -> int:
    """Read a whole number of at least 1."""
    if not text.isdecimal() or int(text) < 1:
        raise ValueError(f'"{text}" is no count; write a whole number, 1 or more')
    return int(text)


@reading
def port(text: str) -> int:
    """Read a TCP port."""
    if not text.isdecimal() or not 0 < int(text) < 65536:
        raise ValueError(f'"{text}" is no port; write a number from 1 to 65535')
    return int(text)
