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
import textwrap
from collections.abc import Mapping, Sequence
from typing import Final, NoReturn

from study.commands.errors import USER_ERRORS, is_ours, name_place, one_line

GROUPS: Final[Mapping[str, tuple[str, ...]]] = {
    "a study and its clips": ("run", "check", "power", "render", "worker", "figures"),
    "eyes": (
        "still",
        "export-scene",
        "inspect",
        "bench",
        "certify",
        "gallery",
        "lod-policy",
        "iris",
    ),
    "people": ("serve", "links", "erase", "simulate", "load"),
    "results": ("export", "analyse", "researcher"),
}
COMMANDS: Final = tuple(name for names in GROUPS.values() for name in names)
EPILOG: Final = (
    "STUDY is a built-in study (thesis, lod, ablation, approach) or the path of a study file.\n"
    "Start with: ocularist run. What a command takes: ocularist COMMAND --help"
)
EXAMPLE: Final = "Example:"
_WIDTH: Final = 20  # of the commands' names in the list


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        """Print where, what was found and where to read on; exit with status 2."""
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)\n")


class Help(argparse.HelpFormatter):
    """Help whose lines part neither names at their hyphens nor examples: both may be copied."""

    def _split_lines(self, text: str, width: int) -> list[str]:
        return textwrap.wrap(text, width, break_on_hyphens=False)

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if text.startswith(EXAMPLE):
            return indent + text
        return textwrap.fill(
            text, width, initial_indent=indent, subsequent_indent=indent, break_on_hyphens=False
        )


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    parser = Parser(
        prog="ocularist",
        usage="ocularist [-h] [--version] COMMAND ...",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="show the version and exit")
    commands = parser.add_subparsers(
        dest="command",
        metavar="COMMAND",
        prog="ocularist",
        required=True,
        help=argparse.SUPPRESS,
    )
    lines = ["How much eye does a viewer need to see? Render, show, ask, analyse."]
    for title, names in GROUPS.items():
        lines += ["", f"{title}:"]
        for name in names:
            command = importlib.import_module(f"study.commands.{name.replace('-', '_')}")
            subparser = commands.add_parser(
                name,
                description=command.DESCRIPTION,
                epilog=f"{EXAMPLE} ocularist {name} {command.EXAMPLE}".rstrip(),
                formatter_class=Help,
            )
            command.add_arguments(subparser)
            subparser.set_defaults(run=command.run)
            lines.append(f"    {name:{_WIDTH - 4}}{command.HELP}")
    parser.description = "\n".join(lines)
    return parser


class _Version(argparse.Action):
    """Prints the version; it is looked up only then."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object, **__: object) -> NoReturn:
        """Print and end."""
        from analysis.words.versions import own_version

        print(f"ocularist {own_version()}")
        parser.exit()


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
        given = vars(options)
        told = name_place(error, [given.get("out"), given.get("data")])
        print(one_line(f"ocularist {options.command}", told), file=sys.stderr)
        return 1
