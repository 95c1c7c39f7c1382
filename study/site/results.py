"""What the answers say so far, behind a switch that records who looked and when.

A researcher who knows the means may treat the next participant differently; so looking is a choice
that leaves a trace. The figures are the report's own, made at most once a minute.
"""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING, Any, Final

from fastapi import APIRouter, HTTPException, Request
from fastapi.responses import HTMLResponse, Response

from study.data import export, researchers
from study.data.database import Database
from study.data.researchers import RESULTS_HIDDEN, RESULTS_SHOWN
from study.data.studies import Study
from study.site.access import redirect
from study.site.dashboard import frame
from study.site.forms import first
from study.site.place import Here, Place
from study.site.signed_in import ResearcherHere, ResearchersForm, SignedIn

if TYPE_CHECKING:
    from analysis import Tables

router = APIRouter(default_response_class=HTMLResponse)
FRESH_S: Final = 60.0
KINDS: Final = ("people", "simulated")


@dataclass
class Gathered:
    """The analysis's tables of one kind of participants at one moment, and figures drawn so far."""

    at: datetime
    made: float
    tables: Tables
    means: list[dict[str, Any]]
    figures: dict[str, bytes] = field(default_factory=dict)


@dataclass
class Drawer:
    """Keeps what was gathered for a minute; matplotlib draws in one thread at a time."""

    kept: dict[tuple[int, str], Gathered] = field(default_factory=dict)
    lock: threading.RLock = field(default_factory=threading.RLock)

    def gathered(self, db: Database, study: Study, kind: str) -> Gathered:
        """Return the tables as of at most a minute ago."""
        with self.lock:
            found = self.kept.get((study.id, kind))
            if found is None or time.monotonic() - found.made > FRESH_S:
                found = _gather(db, study, kind)
                self.kept[study.id, kind] = found
            return found

    def figure(self, db: Database, study: Study, kind: str, name: str) -> bytes:
        """Return a chart as SVG; raises ValueError for a name that is no chart."""
        from analysis import figures
        from analysis.charts.style import figure_bytes

        with self.lock:
            found = self.gathered(db, study, kind)
            if name not in found.figures:
                drawn = figures(found.tables, [name])[name]
                found.figures[name] = figure_bytes(drawn, "svg")
            return found.figures[name]


def _gather(db: Database, study: Study, kind: str) -> Gathered:
    from analysis import tables_from
    from analysis.descriptive import mean_ratings

    stored = export.tables(db, study)
    frames = {
        name: table[table["simulated"].fillna(False) == (kind == "simulated")]
        for name, table in (
            ("ratings", stored.ratings),
            ("comparisons", stored.comparisons),
            ("participants", stored.participants),
        )
    }
    tables = tables_from(frames, source=study.title, codebook=stored.codebook)
    means = mean_ratings(tables.ratings, ["distance", "lod"]).astype(object)
    rows = means.where(means.notna(), None).to_dict(orient="records")
    return Gathered(
        at=db.now(),
        made=time.monotonic(),
        tables=tables,
        means=[{str(name): value for name, value in row.items()} for row in rows],
    )


def _drawer(request: Request) -> Drawer:
    state = request.app.state
    if not hasattr(state, "drawer"):
        state.drawer = Drawer()
    found: Drawer = state.drawer
    return found


@router.get("/researcher/results")
def results(
    request: Request, here: Here, researcher: ResearcherHere, data: str = KINDS[0]
) -> Response:
    """Show figures and means, or explain the switch."""
    study = here.study()
    common = {
        **frame(study, researcher, "/results", "Results"),
        "log": [
            entry
            for entry in researchers.logged(here.db, study)
            if entry.kind in (RESULTS_SHOWN, RESULTS_HIDDEN)
        ][:20],
    }
    if not _sees(here, researcher, study):
        return here.page("researcher/results_hidden.html", **common, fault="")
    from analysis import CHARTS

    kind = data if data in KINDS else KINDS[0]
    gathered = _drawer(request).gathered(here.db, study, kind)
    return here.page(
        "researcher/results.html",
        **common,
        kind=kind,
        gathered=gathered,
        charts=CHARTS,
        people=gathered.tables.ratings["participant"].nunique(),
    )


def _sees(here: Place, researcher: SignedIn, study: Study) -> bool:
    return researchers.sees_results(here.db, researcher.researcher, study)


@router.post("/researcher/results")
def switch(here: Here, researcher: ResearcherHere, fields: ResearchersForm) -> Response:
    """Switch the results on, if it was confirmed, or off; either way it is recorded."""
    study = here.study()
    wants = first(fields, "show") == "yes"
    if wants and first(fields, "sure") != "yes":
        return here.page(
            "researcher/results_hidden.html",
            status=422,
            **frame(study, researcher, "/results", "Results"),
            log=[],
            fault="Please tick the sentence first.",
        )
    researchers.show_results(here.db, researcher.researcher, study, shown=wants)
    return redirect("/researcher/results")


@router.get("/researcher/results/{kind}/{name}.svg")
def figure(
    request: Request, here: Here, researcher: ResearcherHere, kind: str, name: str
) -> Response:
    """Draw one chart, for those who have the results switched on."""
    study = here.study()
    if not _sees(here, researcher, study):
        raise HTTPException(403)
    if kind not in KINDS:
        raise HTTPException(404)
    try:
        drawn = _drawer(request).figure(here.db, study, kind, name)
    except ValueError:
        raise HTTPException(404) from None
    return Response(drawn, media_type="image/svg+xml")
