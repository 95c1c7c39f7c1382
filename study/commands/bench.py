"""``ocularist bench``: what a frame costs, for each LoD at each distance."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from study.commands.options import size

if TYPE_CHECKING:
    from tqdm import tqdm

    from renderer.bench import Cost

HELP = "measure what each LoD costs"
DESCRIPTION = (
    "Time whole frames with two eyes, for each LoD at each distance: the last row of the thesis's "
    "Table 5.1, on this machine. Prints a table and writes it for ocularist analyse --bench."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    from renderer.clip import DISTANCES
    from renderer.detail import STANDARD_LODS

    parser.add_argument(
        "--size",
        type=size,
        default=(1920, 1080),
        metavar="WIDTHxHEIGHT",
        help="picture size (default: 1920x1080)",
    )
    parser.add_argument(
        "--distance",
        action="append",
        choices=DISTANCES,
        help="this distance only; may be given several times",
    )
    parser.add_argument(
        "--lod",
        action="append",
        choices=STANDARD_LODS,
        help="this LoD only; may be given several times",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("out/bench.json"),
        metavar="FILE.json",
        help="where to write the rows (default: %(default)s)",
    )


def run(options: argparse.Namespace) -> int:
    """Measure, print, write."""
    from tqdm import tqdm

    from renderer.bench import run_bench, write_bench
    from renderer.clip import DISTANCES
    from renderer.detail import STANDARD_LODS

    distances = options.distance or DISTANCES
    lods = options.lod or STANDARD_LODS
    with tqdm(
        total=len(distances) * len(lods), unit="LoD", leave=False, disable=not sys.stderr.isatty()
    ) as bar:
        costs = run_bench(
            size=options.size,
            distances=distances,
            lods=lods,
            progress=lambda what: _advance(bar, what),
        )
    write_bench(costs, options.out)
    print("\n".join(table_of(costs)))
    print(f"\nWritten to {options.out}")
    return 0


def _advance(bar: tqdm[Any], what: str) -> None:
    bar.set_description(what)
    bar.update()


def table_of(costs: Sequence[Cost]) -> list[str]:
    """Write the costs as lines: one per distance, one column per LoD, median ms per frame."""
    lods = list(dict.fromkeys(cost.lod for cost in costs))
    cell = {(cost.distance, cost.lod): cost for cost in costs}
    lines = [f"ms per frame (median, two eyes, {costs[0].size}) on {costs[0].renderer}"]
    lines.append(f"{'':12}{'iris px':>8}" + "".join(f"{lod:>10}" for lod in lods))
    for distance in dict.fromkeys(cost.distance for cost in costs):
        row = [cell[distance, lod] for lod in lods]
        lines.append(
            f"{distance:12}{row[0].iris_px:8.0f}"
            + "".join(f"{cost.ms_median:10.1f}" for cost in row)
        )
    return lines
