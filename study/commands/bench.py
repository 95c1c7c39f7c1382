"""``ocularist bench``: what frames, effects, samples, cube maps, a crowd and a start cost here."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from study.commands.errors import CommandError
from study.commands.places import new_file
from study.commands.values import size

if TYPE_CHECKING:
    from renderer.benchmark.plan import Progress
    from renderer.benchmark.result import Bench

HELP = "measure what each LoD and effect costs"
DESCRIPTION = (
    "Time on this machine: frames of each LoD with two eyes and one and what they ask of the "
    "processor, each effect at each level, subsurface by samples, cube maps by size, crowds, and "
    "whether a GPU has the rates that were aimed at; count triangles, texture fetches and "
    "arithmetic per pixel, set-up stages and memory. Prints tables, writes them for ocularist "
    "analyse --bench, and draws a chart. About 15 minutes on 2 cores without a GPU, most of them "
    "for pictures of 1920x1080; leave the machine alone meanwhile. What is measured and how: "
    "docs/benchmark.md."
)
EXAMPLE = "--quick --out bench.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    from renderer.benchmark.result import PARTS

    parser.add_argument(
        "--quick",
        action="store_true",
        help="smaller pictures (640x360), fewer rounds and levels: about 3 minutes",
    )
    parser.add_argument(
        "--only",
        action="append",
        choices=PARTS,
        metavar="PART",
        help=f"measure this part only ({', '.join(PARTS)}); may be given several times",
    )
    parser.add_argument(
        "--size",
        type=size,
        metavar="WIDTHxHEIGHT",
        help="picture size (default: 1920x1080, with --quick 640x360)",
    )
    parser.add_argument(
        "--out",
        type=new_file,
        default="out/bench.json",
        metavar="FILE.json",
        help="where to write the rows; the chart lies beside it (default: %(default)s)",
    )
    parser.add_argument(
        "--from",
        dest="measured",
        type=Path,
        metavar="FILE.json",
        help="measure nothing: print and draw what this file holds",
    )
    parser.add_argument(
        "--markdown", action="store_true", help="print the tables as Markdown instead"
    )


def run(options: argparse.Namespace) -> int:
    """Measure or read, write, draw, print."""
    from renderer.benchmark.chart import write_chart
    from renderer.benchmark.printing import as_markdown, as_text
    from renderer.benchmark.result import write_bench

    if options.out.suffix != ".json":
        raise CommandError(f"--out {options.out}: write a file's name that ends in .json")
    bench = _bench(options)
    if not options.measured:
        write_bench(bench, options.out)
    charts = write_chart(bench, (options.measured or options.out).with_suffix(""))
    print((as_markdown if options.markdown else as_text)(bench))
    written = [*([] if options.measured else [options.out]), *charts]
    if written:
        print("\nWritten: " + ", ".join(map(str, written)), file=sys.stderr)
    return 0


def _bench(options: argparse.Namespace) -> Bench:
    from renderer.benchmark.result import PARTS, read_bench

    if options.measured:
        return read_bench(options.measured)
    from renderer.benchmark.plan import run_bench

    return run_bench(
        options.only or PARTS, is_quick=options.quick, size=options.size, progress=_tell
    )


def _tell(progress: Progress) -> None:
    from study.commands.progress import time_left

    state = f"{progress.share:.0%}{time_left(progress.left_s)}"
    print(f"bench: {progress.title} ({state})", file=sys.stderr, flush=True)
