"""The options of ``ocularist power``, and how their texts are read."""

from __future__ import annotations

import argparse
import os
from typing import Final

from study.commands.options import add_study
from study.commands.places import new_folder
from study.commands.values import count, number, reading, whole_number

MOST_PEOPLE: Final = 5000


@reading
def people(text: str) -> tuple[int, ...]:
    """Read ``10,20,40``: numbers of participants, at least 2 each."""
    words = [word.strip() for word in text.split(",")]
    if not all(word.isdecimal() and 2 <= int(word) <= MOST_PEOPLE for word in words):
        raise ValueError(f'"{text}": write whole numbers from 2 to {MOST_PEOPLE}, like 10,20,40')
    return tuple(sorted({int(word) for word in words}))


@reading
def share(text: str) -> float:
    """Read a share below 1."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value < 1.0:
        raise ValueError(f'"{text}" is no share; write a number from 0 to below 1, like 0.1')
    return value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    parser.add_argument(
        "--participants",
        type=people,
        default=(10, 20, 40, 80),
        metavar="N,N,...",
        help="numbers of people, apart by commas (default: 10,20,40,80)",
    )
    parser.add_argument(
        "--replicates",
        type=count,
        default=400,
        metavar="N",
        help="simulated studies of each number of people (default: %(default)s)",
    )
    parser.add_argument(
        "--truth",
        default="thesis",
        metavar="NAME|FILE.toml",
        help="what people are assumed to see: thesis (as the thesis says in words), equal (no LoD "
        "differs), realism-margin or noticed-margin (every LoD just at a margin, where enough "
        "would be wrong), or a file with losses and shares (default: %(default)s)",
    )
    parser.add_argument(
        "--dropout",
        type=share,
        default=0.0,
        metavar="SHARE",
        help="share of people who leave before the end; what they answered counts "
        "(default: %(default)s)",
    )
    _add_margins(parser)
    parser.add_argument(
        "--seed",
        type=whole_number,
        default=1,
        help="the same seed gives the same result, however many jobs (default: %(default)s)",
    )
    parser.add_argument(
        "--jobs",
        type=count,
        default=os.cpu_count() or 1,
        metavar="N",
        help="processes that work at once (default: one for each processor, here %(default)s)",
    )
    parser.add_argument(
        "--out",
        type=new_folder,
        default="out/power",
        metavar="DIR",
        help="folder for power.csv, power-cheapest.csv, power.json and the chart "
        "(default: %(default)s)",
    )


def _add_margins(parser: argparse.ArgumentParser) -> None:
    for name, metavar, meaning, default in (
        ("realism-margin", "POINTS", "a loss of realism that does not matter", "0.5"),
        ("noticed-margin", "SHARE", "share of people, beyond false alarms, who may notice", "0.25"),
        ("confidence", "SHARE", "confidence of each bound, one-sided", "0.95"),
    ):
        parser.add_argument(
            f"--{name}",
            type=number,
            metavar=metavar,
            help=f"{meaning} (default: what the study declares, else {default})",
        )
