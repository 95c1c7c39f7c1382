"""What ``ocularist render`` is asked about encoding, and what it says of the outcome."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from study.commands.errors import CommandError

if TYPE_CHECKING:
    from renderer.manifest import ClipRecord


def add_encoding(parser: argparse.ArgumentParser) -> None:
    """Add the options about encoding."""
    parser.add_argument(
        "--master",
        action="store_true",
        help="keep every clip's frames without loss beside it (RGB 4:4:4, about 70 MB a second at "
        "1080 lines; never shown to participants); rendered in this process alone",
    )
    parser.add_argument(
        "--no-flip",
        action="store_true",
        help="do not compare encodings with the difference between LoDs by FLIP, which takes some "
        "seconds a clip",
    )


def encoding_choices(options: argparse.Namespace) -> dict[str, bool]:
    """Return what a batch is asked for beyond the clips.

    Raises CommandError where another process is to render: masters do not travel.
    """
    elsewhere = "--scheduler" if options.scheduler else "--workers" if options.workers > 1 else ""
    if elsewhere and options.master:
        raise CommandError(f"--master: only where this process renders; leave out {elsewhere}")
    return {"with_master": options.master, "with_flip": not options.no_flip}


def warn_of_missed(records: Sequence[ClipRecord]) -> None:
    """Say in a line for each clip which bounds its encoding does not hold."""
    for record in records:
        if record.missed:
            spec = record.clip_spec
            name = f"{spec.distance}, {spec.width}x{spec.height} ({record.clip_id})"
            print(f"{name}: {'; '.join(record.missed)}. It is kept.", file=sys.stderr)
