"""``ocularist simulate``: simulated observers take a study, and their data says so."""

from __future__ import annotations

import argparse
import socket
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from study.commands.errors import CommandError
from study.commands.options import add_places, add_study, settings_of
from study.commands.values import count, whole_number

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
EXAMPLE = "thesis --participants 30 --data trial"
SITE_UP_S: Final = 60.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    parser.add_argument(
        "--participants",
        type=count,
        default=10,
        metavar="N",
        help="how many (default: %(default)s)",
    )
    parser.add_argument(
        "--seed",
        type=whole_number,
        default=1,
        help="the same seed gives the same people and answers (default: %(default)s)",
    )
    parser.add_argument(
        "--through-site",
        action="store_true",
        help="let them walk the real pages, of a site started for that; the clips must be rendered",
    )
    parser.add_argument(
        "--url", help="with --through-site: a site that already runs on the same data folder"
    )
    add_places(parser)


def run(options: argparse.Namespace) -> int:
    """Simulate and say where the answers went."""
    from study.design.definition import read_definition

    if options.url and not options.through_site:
        raise CommandError("--url names a site to walk through; add --through-site")
    definition = read_definition(options.study)
    settings = settings_of(options)
    with _bar(options.participants) as bar:
        if options.through_site:
            _through_site(settings, definition, options, bar)
        else:
            _into_database(settings, definition, options, bar)
    print(
        f"{options.participants} simulated participants took {definition.key}, version "
        f"{definition.version}; their answers are in the database, labelled as simulated."
    )
    return 0


def _into_database(
    settings: Settings, definition: StudyDefinition, options: argparse.Namespace, bar: tqdm[Any]
) -> None:
    from study.data.database import open_database
    from study.simulate import simulate

    db = open_database(settings.database_url)
    try:
        simulate(
            db,
            definition,
            participants=options.participants,
            seed=options.seed,
            progress=lambda _done: _advance(bar),
        )
    finally:
        db.close()


def _through_site(
    settings: Settings, definition: StudyDefinition, options: argparse.Namespace, bar: tqdm[Any]
) -> None:
    from study.bots import walk
    from study.site.signatures import simulation_token

    with _site(settings, options.study, options.url) as url:
        walk(
            url,
            definition,
            media_folder=settings.media_folder,
            simulation_token=simulation_token(settings.secret_key()),
            participants=options.participants,
            seed=options.seed,
            report=lambda _done: _advance(bar),
        )


@contextmanager
def _site(settings: Settings, study: str, url: str | None) -> Iterator[str]:
    """Give the address of a site: the one named, or one that runs as long as it is needed."""
    from study.commands.listening import address_of, answers
    from study.commands.starting import start_serving

    if url is not None:
        yield url
        return
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    own = replace(settings, host="127.0.0.1", port=port, tls_cert=None, tls_key=None)
    site = start_serving(own, study)
    try:
        deadline = time.monotonic() + SITE_UP_S
        while not answers(own):
            if site.poll() is not None or time.monotonic() > deadline:
                raise CommandError("the site did not start; ocularist serve says why")
            time.sleep(0.1)
        yield address_of(own)
    finally:
        site.terminate()
        site.wait()


def _bar(total: int) -> tqdm[Any]:
    from tqdm import tqdm

    return tqdm(total=total, unit="person", leave=False, disable=not sys.stderr.isatty())


def _advance(bar: tqdm[Any]) -> None:
    bar.update()
