"""Options that several commands share.

A level is never read without its effect's or eye's name beside it, nor a distance without
``--distance``: the word "medium" alone could be either.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

from study.commands.places import data_folder
from study.commands.values import port

if TYPE_CHECKING:
    from study.settings import Settings

DEFAULT_STUDY: Final = "thesis"


def add_study(parser: argparse.ArgumentParser) -> None:
    """Add the optional STUDY argument."""
    parser.add_argument(
        "study",
        nargs="?",
        default=DEFAULT_STUDY,
        metavar="STUDY",
        help="a built-in study (thesis, lod, ablation, approach) or the path of a study file "
        "(default: %(default)s)",
    )


def add_places(parser: argparse.ArgumentParser) -> None:
    """Add --data, --database and --media: the places where a study's data lie."""
    parser.add_argument(
        "--data",
        type=data_folder,
        metavar="DIR",
        help="folder of everything that is stored (default: ocularist-data)",
    )
    parser.add_argument(
        "--database",
        metavar="URL",
        help="database, such as sqlite:///study.sqlite3 or postgresql+psycopg://host/name "
        "(default: an SQLite file in the data folder)",
    )
    parser.add_argument(
        "--media",
        type=Path,
        metavar="DIR",
        help="folder of the clips (default: in the data folder)",
    )


def add_costs(parser: argparse.ArgumentParser) -> None:
    """Add --bench: where the costs of the LoDs stand that the dashboard's figures show."""
    parser.add_argument(
        "--bench",
        type=Path,
        metavar="FILE.json",
        help="costs measured by ocularist bench, for the dashboard's figures (default: bench.json "
        "in the data folder, if there is one)",
    )


def add_listening(parser: argparse.ArgumentParser) -> None:
    """Add where the site listens, and its certificate."""
    parser.add_argument(
        "--host",
        help="address to listen on; 0.0.0.0 lets others on the network in (default: 127.0.0.1)",
    )
    parser.add_argument("--port", type=port, help="port to listen on (default: 8000)")
    parser.add_argument("--tls-cert", type=Path, metavar="FILE", help="certificate, for https")
    parser.add_argument("--tls-key", type=Path, metavar="FILE", help="its private key")


def settings_of(options: argparse.Namespace) -> Settings:
    """Combine these options with the environment and the defaults."""
    from study.settings import read_settings

    given = vars(options)
    return read_settings(
        os.environ,
        data_folder=given.get("data"),
        database=given.get("database"),
        media=given.get("media"),
        bench=given.get("bench"),
        host=given.get("host"),
        port=given.get("port"),
        tls_cert=given.get("tls_cert"),
        tls_key=given.get("tls_key"),
    )
