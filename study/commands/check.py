"""``ocularist check``: read a study file, tell every fault at once, and audit the design."""

from __future__ import annotations

import argparse

from study.commands.options import add_study

HELP = "check a study file and audit its design"
DESCRIPTION = (
    "Read a study file and report every fault with its place, what was found and what is accepted. "
    "A sound file is summed up, with warnings about what the study cannot show."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
