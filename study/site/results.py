"""What the answers say so far, behind a switch that records who looked and when.

A researcher who knows the means may treat the next participant differently; so looking is a choice
that leaves a trace. Nothing is computed here: a worker draws the report's own figures at most once
a minute (``study.figures``), and these pages show what it has stored.
"""

from __future__ import annotations

from typing import Final

from fastapi import APIRouter, HTTPException
from fastapi.responses import HTMLResponse, Response

from study.data import figures_shown, logbook
from study.data.figures_due import KINDS
from study.data.logbook import RESULTS_HIDDEN, RESULTS_SHOWN
from study.data.studies import Study
from study.site.access import redirect
from study.site.dashboard import frame
from study.site.forms import first
from study.site.place import Here, Place
from study.site.signed_in import ResearcherHere, ResearchersForm, SignedIn

router = APIRouter(default_response_class=HTMLResponse)
# What a browser may show, and what it may only take away: a report is a page with styles of its
# own, which these pages' policy would strip.
TYPES: Final = {
    "svg": ("image/svg+xml", "inline"),
    "csv": ("text/csv; charset=utf-8", "attachment"),
    "html": ("text/html; charset=utf-8", "attachment"),
    "json": ("application/json", "attachment"),
}

TO_LOAD: Final = {
    "decision.csv": "each verdict, one row per distance and LoD",
    "lod_policy.json": "up to which size of the iris each LoD is enough",
}
"""What a program or an engine loads of the answer, and what it holds."""


@router.get("/researcher/results")
def results(here: Here, researcher: ResearcherHere, data: str = KINDS[0]) -> Response:
    """Show answer and figures as of the last drawing, or explain the switch."""
    study = here.study()
    common = {
        **frame(study, researcher, "/results", "Results"),
        "log": [
            entry
            for entry in logbook.logged(here.db, study)
            if entry.kind in (RESULTS_SHOWN, RESULTS_HIDDEN)
        ][:20],
    }
    if not _sees(here, researcher, study):
        return here.page("researcher/results_hidden.html", **common, fault="")
    kind = data if data in KINDS else KINDS[0]
    found = figures_shown.latest(here.db, study.id, kind)
    there = () if found.id is None else figures_shown.names(here.db, found.id)
    to_load = {name: words for name, words in TO_LOAD.items() if name in there}
    return here.page("researcher/results.html", **common, kind=kind, found=found, to_load=to_load)


def _sees(here: Place, researcher: SignedIn, study: Study) -> bool:
    return logbook.sees_results(here.db, researcher.researcher, study)


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
    logbook.show_results(here.db, researcher.researcher, study, shown=wants)
    return redirect("/researcher/results")


@router.get("/researcher/results/{kind}/{name}")
def file(here: Here, researcher: ResearcherHere, kind: str, name: str) -> Response:
    """Give one file of the last drawing, to those who have the results switched on."""
    study = here.study()
    if not _sees(here, researcher, study):
        raise HTTPException(403)
    ending = name.rpartition(".")[2]
    if kind not in KINDS or ending not in TYPES:
        raise HTTPException(404)
    found = figures_shown.latest(here.db, study.id, kind)
    content = None if found.id is None else figures_shown.content(here.db, found.id, name)
    if content is None:
        raise HTTPException(404)
    media_type, disposition = TYPES[ending]
    own = f"{study.key}-{kind}-{name}" if disposition == "attachment" else name
    headers = {"content-disposition": f'{disposition}; filename="{own}"'}
    return Response(content, media_type=media_type, headers=headers)
