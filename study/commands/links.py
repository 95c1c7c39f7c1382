"""``ocularist links``: personal links to a study, one per person, as a table to send out."""

from __future__ import annotations

import argparse
import csv
import io
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from study.commands.errors import CommandError
from study.commands.options import add_listening, add_places, add_study, settings_of
from study.commands.places import new_file
from study.commands.values import count

if TYPE_CHECKING:
    from study.data.links import NewLink

HELP = "make personal one-time links"
DESCRIPTION = (
    "Make personal links to a study and write them into a table. Each lets in one person, once, "
    "and brings them back to their place on any device until they have finished. The database "
    "keeps hashes only: this table is the only place where the links can be read."
)
EXAMPLE = "thesis --count 20 --url https://study.example.org"
MOST: Final = 100_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    parser.add_argument("--count", type=count, required=True, metavar="N", help="how many")
    parser.add_argument(
        "--out",
        type=new_file,
        metavar="FILE",
        help="the table, a CSV file that is not there yet (default: links-KEY.csv)",
    )
    parser.add_argument(
        "--url",
        metavar="URL",
        help="address of the site as participants see it, such as https://study.example.org "
        "(default: what --host and --port say)",
    )
    add_places(parser)
    add_listening(parser)


def run(options: argparse.Namespace) -> int:
    """Make the links and say where they are."""
    from study.commands.listening import address_of
    from study.commands.preparing import prepare, tell_if_new
    from study.data import links

    if options.count > MOST:
        raise CommandError(f"--count {options.count}: make at most {MOST} links at a time")
    settings = settings_of(options)
    url = _site(options.url) if options.url else address_of(settings)
    tell_if_new(settings)
    prepared = prepare(settings, options.study)
    out = options.out or Path(f"links-{prepared.study.key}.csv")
    try:
        # The file and its room on the disk first: links that nobody can read would let nobody in.
        longest = len(f"{2**63},{url}/link/") + 64
        descriptor = _new_file(out, size=longest * (options.count + 1))
        made = links.make(prepared.db, prepared.study, options.count)
        with os.fdopen(descriptor, "w", encoding="utf-8") as file:
            file.write(table_of(made, url))
            file.truncate()
        found = links.counts(prepared.db, prepared.study)
    finally:
        prepared.db.close()
    print(out)
    print(f"{len(made)} new personal links; in all {found.used} used and {found.unused} unused.")
    return 0


def table_of(made: Sequence[NewLink], url: str) -> str:
    """Write links as CSV: their number, and the address to send."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["number", "link"])
    writer.writerows([link.number, f"{url}/link/{link.token}"] for link in made)
    return text.getvalue()


def _site(url: str) -> str:
    if not url.startswith(("http://", "https://")):
        raise CommandError(f"--url {url}: no address; begin it with https:// or http://")
    return url.rstrip("/")


def _new_file(path: Path, *, size: int) -> int:
    """Make a file that its owner alone can read; whoever has a link can take part with it.

    ``size`` bytes are set aside for it; where the disk has no room no file is left.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600)
    except FileExistsError:
        raise CommandError(
            f"{path}: there is such a file; name another with --out, links in it may be in use"
        ) from None
    except OSError as error:
        raise CommandError(f"{path}: cannot be written ({error.strerror})") from None
    try:
        os.posix_fallocate(descriptor, 0, size)
    except OSError as error:
        os.close(descriptor)
        path.unlink()
        raise CommandError(f"{path}: cannot be written ({error.strerror})") from None
    return descriptor
