"""``ocularist simulate``: simulated observers take a study, and their data says so."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

from study.commands.options import add_places, add_study, count, settings_of

if TYPE_CHECKING:
    from tqdm import tqdm

    from study.design.definition import StudyDefinition
    from study.settings import Settings

HELP = "let simulated observers take a study"
DESCRIPTION = (
    "Let simulated observers take a study, from consent to completion code. They answer as the "
    "thesis says that people did, with noise; their answers try out a study and its analysis and "
    "say nothing about eyes. Simulated data is labelled so wherever it appears."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    parser.add_argument(
        "--participants", type=count, default=10, help="how many (default: %(default)s)"
    )
    parser.add_argument(
        "--seed",
        type=int,
        default=1,
        help="the same seed gives the same people and answers (default: %(default)s)",
    )
    add_places(parser)


def run(options: argparse.Namespace) -> int:
    """Simulate and say where the answers went."""
    from study.design.definition import read_definition

    definition = read_definition(options.study)
    settings = settings_of(options)
    _into_database(settings, definition, options)
    print(
        f"{options.participants} simulated participants took {definition.key}, version "
        f"{definition.version}; their answers are in the database, labelled as simulated."
    )
    return 0


def _into_database(
    settings: Settings, definition: StudyDefinition, options: argparse.Namespace
) -> None:
    from tqdm import tqdm

    from study.data.database import open_database
    from study.simulate import simulate

    db = open_database(settings.database_url)
    try:
        with tqdm(
            total=options.participants, unit="person", leave=False, disable=not sys.stderr.isatty()
        ) as bar:
            simulate(
                db,
                definition,
                participants=options.participants,
                seed=options.seed,
                progress=lambda _done: _advance(bar),
            )
    finally:
        db.close()


def _advance(bar: tqdm[Any]) -> None:
    bar.update()
