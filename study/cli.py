"""``ocularist``: the entry point, and the only place that puts the rooms together.

Every command is a module of ``study.commands`` with ``NAME``, ``HELP``, ``add_arguments`` and
``run``. They import what they need when they run: a web machine needs no GL, a render machine no
database, an analyst neither.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Sequence
from typing import Final, NoReturn

from study.commands.errors import USER_ERRORS, is_ours, one_line

COMMANDS: Final = (
    "run",
    "check",
    "power",
    "render",
    "worker",
    "figures",
    "still",
    "export-scene",
    "inspect",
    "bench",
    "certify",
    "gallery",
    "lod-policy",
    "iris",
    "serve",
    "links",
    "erase",
    "simulate",
    "load",
    "export",
    "analyse",
    "researcher",
)
EPILOG: Final = (
    "STUDY is a built-in study (thesis, lod, approach) or the path of a study file. "
    "Start with: ocularist run"
)


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        """Print where, what was found and where to read on; exit with status 2."""
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)\n")


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    parser = Parser(
        prog="ocularist",
        description="How much eye does a viewer need to see? Render, show, ask, analyse.",
        epilog=EPILOG,
    )
    subparsers = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name in COMMANDS:
        command = importlib.import_module(f"study.commands.{name.replace('-', '_')}")
        subparser = subparsers.add_parser(name, help=command.HELP, description=command.DESCRIPTION)
        command.add_arguments(subparser)
        subparser.set_defaults(run=command.run)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return the exit status.

    What a user can mend is told in one line (or one line per fault) on stderr with status 1;
    ``OCULARIST_TRACEBACK=1`` shows where in the code it came from.
    """
    options = build_parser().parse_args(arguments)
    try:
        return int(options.run(options) or 0)
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # somebody closed our output, as `| head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python flushes it at exit
        return 141
    except USER_ERRORS as error:
        if os.environ.get("OCULARIST_TRACEBACK") or is_ours(error):
            raise
        print(one_line(f"ocularist {options.command}", error), file=sys.stderr)
        return 1
