"""``ocularist erase``: withdraw somebody who asks the researcher for it."""

from __future__ import annotations

import argparse

from study.commands.errors import CommandError
from study.commands.options import add_places, settings_of

HELP = "erase one participant"
DESCRIPTION = (
    "Erase everything about one participant, as if they had withdrawn themselves. Only the day and "
    "the step at which somebody withdrew stay. Tables that were exported before are not changed."
)
EXAMPLE = "p-4k7mz2qd"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument(
        "who",
        metavar="WHO",
        help="the pseudonym, such as p-4k7mz2qd, or the completion code that a participant got",
    )
    parser.add_argument("--yes", action="store_true", help="do not ask")
    add_places(parser)


def run(options: argparse.Namespace) -> int:
    """Erase and say so."""
    from study.commands.preparing import open_existing
    from study.data import erasure, participants, studies

    db = open_existing(settings_of(options))
    try:
        person = participants.by_name(db, options.who)
        person = person or participants.by_code(db, options.who)
        if person is None:
            raise CommandError(
                f"{options.who}: nobody has this pseudonym or this code of their own; the "
                "dashboard's people page lists the pseudonyms"
            )
        study = studies.by_id(db, person.study_id)
        if not options.yes and not _is_sure(f"{person.public_id}, study {study.key}"):
            raise CommandError("nothing was erased")
        erasure.withdraw(db, person)
    finally:
        db.close()
    print(f"{person.public_id} is erased.")
    return 0


def _is_sure(who: str) -> bool:
    try:
        return input(f"Erase {who}? This cannot be undone. [yes/no] ").strip().lower() == "yes"
    except EOFError:
        return False
