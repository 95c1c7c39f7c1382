"""A table, and what stands in its cells. Pure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from renderer.benchmark.result import Cost, Work
from renderer.benchmark.verdicts import bound_by, frames_per_s

NOTHING: Final = "-"  # not measured


@dataclass(frozen=True)
class Table:
    """A title, a note that says how to read it, a head and rows of cells; the first is a name."""

    title: str
    note: str
    head: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


def is_on_gpu(rows: Sequence[Cost]) -> bool:
    """Say whether whole frames were drawn in a row, as on a GPU alone."""
    return any(row.row_ms is not None for row in rows)


def ms(row: Cost | None) -> str:
    """Return median ± MAD; "≤" where most rounds count a GPU's waiting for commands."""
    if not row:
        return NOTHING
    at_most = "≤ " if 2 * (row.gaps or 0) > row.n else ""
    return f"{at_most}{row.ms_median:.1f} ± {row.ms_mad:.1f}"


def rate(row: Cost) -> str:
    """Return frames/s."""
    found = frames_per_s(row)
    return f"{found:.3g}" if found else NOTHING


def frames(row: Cost | None) -> str:
    """Return a whole frame's time and rate."""
    return f"{ms(row)} ({rate(row)}/s)" if row else NOTHING


def processor(row: Cost | None) -> str:
    """Return the processor's ms and the draw calls, on a GPU with what bounds the rate."""
    if not row or row.processor_ms is None:
        return NOTHING
    return f"{row.processor_ms:.1f} ({row.draw_calls}) {bound_by(row)}".rstrip()


def counts(work: Work | None) -> str:
    """Return fetches and arithmetic that an effect adds."""
    return f"{work.fetches:+.1f} {work.arithmetic:+.0f}" if work else NOTHING
