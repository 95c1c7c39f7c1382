"""``ocularist worker``: render the clips that a database waits for."""

from __future__ import annotations

import argparse
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from study.commands.options import add_places, settings_of

if TYPE_CHECKING:
    from renderer.studio import Studio
    from study.data.database import Database
    from study.settings import Settings
    from study.worker import Render

HELP = "render the clips that a database waits for"
DESCRIPTION = (
    "Claim and render clips until stopped. Several workers may share one database: no clip is "
    "rendered twice, and one that is killed loses only its clip. Beside that it draws the "
    "dashboard's figures where answers have come."
)
EXAMPLE = "--database postgresql+psycopg://host/study --media /srv/clips"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_places(parser)
    parser.add_argument(
        "--until-empty", action="store_true", help="stop when no clip is waiting any more"
    )


def run(options: argparse.Namespace) -> int:
    """Render until stopped by Ctrl-C or SIGTERM."""
    from renderer.production.folder import remove_parts
    from renderer.studio import Studio
    from study.commands.preparing import open_existing
    from study.worker import run_worker, stopping_on_signals

    settings = settings_of(options)
    db = open_existing(settings)
    studio = Studio()  # before any clip is claimed: a machine without GL says so at once
    remove_parts(settings.media_folder)  # what a killed worker left
    try:
        with stopping_on_signals() as stop, _figures_beside(db, settings, options.until_empty):
            rendered = run_worker(
                db,
                settings.media_folder,
                render=rendering_with(studio),
                stop=stop,
                until_empty=options.until_empty,
                say=lambda line: print(line, file=sys.stderr, flush=True),
            )
    finally:
        studio.close()
        db.close()
    if options.until_empty:
        count = f"{rendered} clip{'' if rendered == 1 else 's'}"
        print(f"{count} rendered into {settings.media_folder}")
    return 0


@contextmanager
def _figures_beside(db: Database, settings: Settings, until_empty: bool) -> Iterator[None]:
    """Have the dashboard's figures drawn beside the rendering, unless it is to end when done."""
    from study.commands.processes import ending
    from study.commands.starting import start_drawing
    from study.figure_keeper import FigureKeeper, keep_figures

    if until_empty:
        yield
        return
    keeper = FigureKeeper(
        db,
        lambda name: start_drawing(settings, name),
        ending=ending,
        say=lambda line: print(line, file=sys.stderr, flush=True),
    )
    stop = threading.Event()
    # The children end with this thread if the worker is killed, so it lives as long as the worker.
    thread = threading.Thread(target=keep_figures, args=(keeper, stop), name="figures")
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def rendering_with(studio: Studio) -> Render:
    """Return what a worker calls to have one clip rendered in this process's GL context."""
    from renderer.production.batch import render_clip

    return lambda spec, folder, progress: render_clip(
        spec, folder, source=studio, progress=progress
    )
