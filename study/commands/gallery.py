"""``ocularist gallery``: strips of stills that show what each part of the renderer does."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from study.commands.places import new_folder
from study.commands.values import size

if TYPE_CHECKING:
    from renderer.gallery.strips import Strip

HELP = "draw the gallery or the contact sheets"
DESCRIPTION = (
    "Draw strips of stills (LoDs, effects, irises, sun, gaze, the thesis's own forms) and the page "
    "that explains them, README.md in the same folder. A strip that is there and current is not "
    "drawn again; an interrupted run goes on where it stopped."
)
EXAMPLE = "--only lods-near"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument(
        "--out",
        type=new_folder,
        metavar="DIR",
        help="folder of the pictures (default: out/gallery, or out/sheets with --sheets)",
    )
    parser.add_argument(
        "--only",
        action="append",
        default=[],
        metavar="NAME",
        help="draw this strip only, even where it is current; may be given several times",
    )
    parser.add_argument("--list", action="store_true", help="print the strips' names and titles")
    parser.add_argument(
        "--sheets",
        action="store_true",
        help="draw contact sheets instead: every LoD and distance from five azimuths",
    )
    parser.add_argument(
        "--size",
        type=size,
        default=(1280, 720),
        metavar="WIDTHxHEIGHT",
        help="size of the pictures that strips are cut from (default: 1280x720)",
    )
    parser.add_argument(
        "--png", action="store_true", help="write exact PNG files instead of small JPEG files"
    )
    parser.add_argument(
        "--certificate",
        type=Path,
        default=Path("out/certification"),
        metavar="DIR",
        help="folder that ocularist certify has written its figures to (default: %(default)s)",
    )


def run(options: argparse.Namespace) -> int:
    """Draw the strips that are wanted and say where they are."""
    from renderer.gallery.making import chosen, make_strips
    from renderer.gallery.sheets import SHEETS
    from renderer.gallery.table import gallery_strips

    strips = SHEETS if options.sheets else gallery_strips(options.certificate)
    wanted = chosen(strips, options.only)
    if options.list:
        for strip in wanted:
            print(f"{strip.name:20} {strip.title}")
        return 0
    folder = options.out or Path("out/sheets" if options.sheets else "out/gallery")
    kind = "png" if options.png else "jpg"
    began = time.monotonic()
    for strip, path, is_new in make_strips(
        wanted, folder, size=options.size, kind=kind, anew=bool(options.only)
    ):
        spent_s, began = time.monotonic() - began, time.monotonic()
        said = f"{spent_s:.0f} s, {path.stat().st_size / 1024:.0f} KB" if is_new else "is current"
        print(f"{strip.name:20} {path}  {said}", flush=True)
    if not options.sheets:
        print(_write_page(strips, folder, kind))
    return 0


def _write_page(strips: Sequence[Strip], folder: Path, kind: str) -> Path:
    from renderer.atomic_file import write_atomically
    from renderer.gallery.page import PAGE, measured_strands, page_of

    names = {strip.name: f"{strip.name}.{kind}" for strip in strips}
    files = {name: file for name, file in names.items() if (folder / file).is_file()}
    page = page_of(strips, files, measured_strands())
    write_atomically(folder / PAGE, page.encode())
    return folder / PAGE
