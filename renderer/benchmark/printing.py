"""The benchmark's tables for a terminal and as Markdown. Pure."""

from __future__ import annotations

from textwrap import fill
from typing import Final

from renderer.benchmark.cells import Table
from renderer.benchmark.clock import WALL
from renderer.benchmark.result import Bench
from renderer.benchmark.tables import tables_of

WIDTH: Final = 100  # of prose in a terminal
BUSY: Final = 1.75  # times its own load: what tells that a benchmark was not alone


def as_text(bench: Bench) -> str:
    """Return all tables for a terminal."""
    about = (fill(paragraph, WIDTH) for paragraph in _about(bench))
    return "\n\n".join([*about, *map(_text, tables_of(bench))])


def as_markdown(bench: Bench) -> str:
    """Return all tables as Markdown, under headings of the third level."""
    return "\n\n".join([*_about(bench), *map(_markdown, tables_of(bench))])


def _about(bench: Bench) -> list[str]:
    """Return the conditions, and a warning where they were bad."""
    about = bench.about
    quick = ", in a hurry (--quick)" if about.is_quick else ""
    loads = [row.load for row in bench.rows]
    meanwhile = f", {min(loads):g} to {max(loads):g} meanwhile" if loads else ""
    conditions = (
        f"{about.renderer} ({about.gl_version}); {about.processor}, {about.cores} cores; "
        f"{about.size} pixels; {about.clock}; load {about.load_before:g} before{meanwhile}; "
        f"{about.seconds / 60:.1f} min{quick}; code {about.code_version}"
    )
    own = about.cores if about.clock == WALL else 1
    if max(loads, default=0.0) <= own * BUSY:
        return [conditions]
    return [
        conditions,
        f"Other work was running: the benchmark itself makes a load of about {own}. Times are too "
        "long, differences uncertain; measure again on a quiet machine.",
    ]


def _text(table: Table) -> str:
    widths = [max(map(len, column)) for column in zip(table.head, *table.rows, strict=True)]
    lines = [
        "  ".join(
            cell.ljust(width) if place == 0 else cell.rjust(width)
            for place, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in (table.head, *table.rows)
    ]
    return "\n".join([table.title, fill(table.note, WIDTH), "", *lines])


def _markdown(table: Table) -> str:
    rule = ["---", *["---:"] * (len(table.head) - 1)]
    lines = ["| " + " | ".join(row) + " |" for row in (table.head, rule, *table.rows)]
    return "\n".join([f"### {table.title}", table.note, "", *lines])
