"""Draw the dashboard's figures: the analysis's own report of what has been answered so far.

Runs in a process of its own, so that neither a page nor a clip waits for it; knows no web.
"""

from __future__ import annotations

import tempfile
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from analysis import CHARTS, Summary, TableError, analyse, read_bench, tables_from
from study.data import export, figures, studies
from study.data.database import Database
from study.data.figures import Claim
from study.data.figures_due import SIMULATED
from study.data.studies import Study

BEAT_S: Final = 20.0
# A picture in pixels can be had from the report's command.
KEPT: Final = (".svg", ".csv", ".html", ".json")
Say = Callable[[str], None]


def draw_claimed(db: Database, *, worker: str, bench: Path | None = None) -> bool:
    """Draw the set that ``worker`` has claimed and store it; False where the claim was lost.

    ``bench`` is where the LoDs' costs stand, if that file is there. What goes wrong is stored for
    the dashboard before it is raised.
    """
    own = figures.claimed(db, worker=worker)
    if own is None:
        return False
    try:
        with _kept_alive(db, own, worker):
            summary, files = draw(db, studies.by_id(db, own.study_id), own.kind, bench=bench)
    except Exception as error:
        reason = "".join(traceback.format_exception(error))
        figures.fail(db, own, worker=worker, error=reason)
        raise
    return figures.store(db, own, worker=worker, summary=summary, files=files)


def draw(
    db: Database, study: Study, kind: str, *, bench: Path | None = None
) -> tuple[dict[str, Any], dict[str, bytes]]:
    """Analyse one kind of a study's answers; return the summary and the files by name.

    With ``bench`` they tell what the LoDs cost; a faulty file is told and costs are left out.
    """
    stored = export.tables(db, study)
    frames = {
        name: table[table["simulated"].fillna(False) == (kind == SIMULATED)]
        for name, table in (
            ("ratings", stored.ratings),
            ("comparisons", stored.comparisons),
            ("participants", stored.participants),
        )
    }
    tables = tables_from(frames, source=study.title, codebook=stored.codebook)
    with tempfile.TemporaryDirectory(prefix="ocularist-figures-") as folder:
        costs, faults = _costs(bench)
        found = analyse(tables, folder, bench=costs)
        files = {path.name: path.read_bytes() for path in _files(found) if path.suffix in KEPT}
    summary = _summary(found)
    summary["limits"] += faults
    return summary, files


def _costs(bench: Path | None) -> tuple[Path | None, list[str]]:
    """Return the file of costs if it is there and can be read, and what is wrong with it."""
    if bench is None or not bench.is_file():
        return None, []
    try:
        read_bench(bench)
    except TableError as error:
        fault = "; ".join(str(error).splitlines())
        return None, [f"What the LoDs cost is left out, for {bench.name} cannot be used: {fault}."]
    return bench, []


def _files(found: Summary) -> Iterator[Path]:
    yield from (path for path in found.files if path.is_file())


def _summary(found: Summary) -> dict[str, Any]:
    """Return what stands beside the figures, as plain values."""
    return {
        "people": found.people,
        "ratings": found.ratings,
        "verdicts": [list(pair) for pair in found.verdicts],
        "findings": [[own.distance, own.sentence] for own in found.findings],
        "limits": list(found.limits),
        "design": list(found.design),
        "quality": [*found.quality, *found.chart_notes],
        "charts": [
            {"name": chart.name, "part": chart.part, "title": chart.title, "caption": chart.caption}
            for chart in CHARTS
        ],
    }


@contextmanager
def _kept_alive(db: Database, own: Claim, worker: str) -> Iterator[None]:
    """Renew the claim's lease while the block lasts."""
    ended = threading.Event()

    def keep() -> None:
        while not ended.wait(BEAT_S):
            if not figures.renew(db, own, worker=worker):
                return

    thread = threading.Thread(target=keep, name="lease", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
