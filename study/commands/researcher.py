"""``ocularist researcher add``: an account for the dashboard, or a new password for one."""

from __future__ import annotations

import argparse
import getpass
import secrets
import sys
from typing import TYPE_CHECKING, Final

from study.commands.errors import CommandError
from study.commands.options import add_places, settings_of

if TYPE_CHECKING:
    from study.data.database import Database

HELP = "make an account for the dashboard"
DESCRIPTION = "Make accounts for the researcher's dashboard."
EXAMPLE = "add ada"
ALPHABET: Final = "23456789abcdefghjkmnpqrstvwxyz"  # nothing that reads like something else
FIRST_NAME: Final = "researcher"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    add = actions.add_parser(
        "add",
        help="make an account, or give one a new password",
        description="Make an account for the dashboard, or give an existing one a new password. "
        "The password is asked for; without a terminal it is read from the first line of input.",
    )
    add.add_argument("name", metavar="NAME", help="name to sign in with")
    add.add_argument(
        "--generate", action="store_true", help="make up a password and print it, once"
    )
    add_places(add)


def run(options: argparse.Namespace) -> int:
    """Make the account."""
    from study.commands.preparing import tell_if_new
    from study.data import researchers
    from study.data.database import open_database

    settings = settings_of(options)
    tell_if_new(settings)
    password = new_password() if options.generate else _ask(options.name)
    db = open_database(settings.database_url)
    try:
        researcher = researchers.add(db, options.name, password)
    finally:
        db.close()
    print(f"{researcher.name} can sign in now.")
    if options.generate:
        print(f"Password: {password}")
    return 0


def new_password() -> str:
    """Return a random password of about 78 bits, easy to read out and to type."""
    groups = ["".join(secrets.choice(ALPHABET) for _ in range(4)) for _ in range(4)]
    return "-".join(groups)


def add_first(db: Database) -> str | None:
    """Make the first account, if there is none yet, and return its password."""
    from study.data import researchers

    if researchers.has_any(db):
        return None
    password = new_password()
    researchers.add(db, FIRST_NAME, password)
    return password


def _ask(name: str) -> str:
    if not sys.stdin.isatty():
        return sys.stdin.readline().rstrip("\n")
    password = getpass.getpass(f"Password for {name}: ")
    if getpass.getpass("Once more: ") != password:
        raise CommandError("the two passwords differ; nothing was changed")
    return password
