"""What a load run measured, as a table and as plain values."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

from study.load.crowd import ANSWERS, KINDS, Timings

HEAD: Final = (
    *("database", "processes", "fsync", "people", "pause s"),
    *("answers/s", "requests/s", "p50 ms", "p95 ms", "p99 ms", "errors", "lost"),
    *("site ms", "crowd ms"),
)


KIND_HEAD: Final = (
    *("database", "processes", "fsync", "people", "pause s"),
    *("kind", "requests/s", "p50 ms", "p95 ms", "p99 ms"),
)


@dataclass(frozen=True)
class KindFigures:
    """How long requests of one kind took."""

    kind: str
    requests_per_s: float
    p50_ms: float
    p95_ms: float
    p99_ms: float

    def cells(self) -> list[str]:
        """Return the cells of a table's row."""
        times = (self.requests_per_s, self.p50_ms, self.p95_ms, self.p99_ms)
        return [self.kind, *(f"{value:.0f}" for value in times)]


@dataclass(frozen=True)
class Figures:
    """One run: where, with how many, and what came out. Times are of all requests.

    ``site_ms`` and ``crowd_ms`` are processor time per request: the site's with its database's
    server, and that of the simulated people, who share the machine. ``there`` of the ``people`` had
    come to the clips when the measurement began.
    """

    database: str
    processes: int
    fsync: bool
    people: int
    there: int
    pause_s: float
    seconds: float
    answers_per_s: float
    requests_per_s: float
    questionnaires_per_s: float
    p50_ms: float
    p95_ms: float
    p99_ms: float
    errors: int
    lost: int
    site_ms: float
    crowd_ms: float
    kinds: tuple[KindFigures, ...] = ()

    def row(self) -> list[str]:
        """Return the cells of a table's row."""
        return [
            *self.setting(),
            f"{self.answers_per_s:.0f}",
            f"{self.requests_per_s:.0f}",
            *(f"{value:.0f}" for value in (self.p50_ms, self.p95_ms, self.p99_ms)),
            str(self.errors),
            str(self.lost),
            *(f"{value:.2f}" for value in (self.site_ms, self.crowd_ms)),
        ]

    def setting(self) -> list[str]:
        """Return the cells that say where and with how many."""
        return [
            self.database,
            str(self.processes),
            "on" if self.fsync else "off",
            str(self.people) if self.there == self.people else f"{self.there} of {self.people}",
            f"{self.pause_s:g}",
        ]

    def kind_rows(self) -> list[list[str]]:
        """Return the rows of the table of kinds: all that were asked for, and each."""
        of_all = KindFigures("all", self.requests_per_s, self.p50_ms, self.p95_ms, self.p99_ms)
        return [[*self.setting(), *kind.cells()] for kind in (of_all, *self.kinds)]

    def plain(self) -> dict[str, Any]:
        """Return everything as plain values."""
        return asdict(self)


def figures_of(timings: Timings, *, lost: int, **facts: Any) -> Figures:
    """Summarise what was measured; ``facts`` say where and with how many."""
    return Figures(
        **facts,
        answers_per_s=timings.rate(*ANSWERS),
        requests_per_s=timings.rate(),
        questionnaires_per_s=timings.rate("questionnaire"),
        p50_ms=timings.quantile_ms(0.5),
        p95_ms=timings.quantile_ms(0.95),
        p99_ms=timings.quantile_ms(0.99),
        errors=sum(timings.errors.values()),
        lost=lost,
        site_ms=timings.processor_ms(timings.site_s),
        crowd_ms=timings.processor_ms(timings.crowd_s),
        kinds=tuple(_kind(timings, name) for name in KINDS),
    )


def _kind(timings: Timings, name: str) -> KindFigures:
    kinds = KINDS[name]
    quantiles = (timings.quantile_ms(share, *kinds) for share in (0.5, 0.95, 0.99))
    return KindFigures(name, timings.rate(*kinds), *quantiles)


def table(rows: Sequence[Figures]) -> str:
    """Return a Markdown table, one line per run."""
    return _markdown([list(HEAD), *(row.row() for row in rows)])


def kinds_table(rows: Sequence[Figures]) -> str:
    """Return a Markdown table of every run's kinds of requests."""
    return _markdown([list(KIND_HEAD), *(line for row in rows for line in row.kind_rows())])


def _markdown(lines: Sequence[Sequence[str]]) -> str:
    widths = [max(len(line[n]) for line in lines) for n in range(len(lines[0]))]
    text = ["| " + " | ".join(c.rjust(w) for c, w in zip(line, widths, strict=True)) + " |"
            for line in lines]  # fmt: skip
    return "\n".join([text[0], "|" + "|".join("-" * (w + 2) for w in widths) + "|", *text[1:]])


def machine() -> str:
    """Say how many cores there are and how busy they were."""
    return f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"
