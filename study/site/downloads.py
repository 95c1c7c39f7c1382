"""The tables and the codebook to take away; every download is logged."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from typing import Final

from fastapi import APIRouter, HTTPException
from fastapi.responses import HTMLResponse, Response

from study.data import export, logbook
from study.data.export import Tables, csv_of
from study.data.studies import Study
from study.site.dashboard import frame
from study.site.place import Here
from study.site.signed_in import ResearcherHere

router = APIRouter()
FILES: Final[dict[str, tuple[str, Callable[[Tables], str]]]] = {
    "ratings.csv": (
        "one row per participant, trial and eye",
        lambda tables: csv_of(tables.ratings),
    ),
    "comparisons.csv": (
        "one row per trial",
        lambda tables: csv_of(tables.comparisons),
    ),
    "participants.csv": (
        "one row per participant",
        lambda tables: csv_of(tables.participants),
    ),
    "codebook.json": (
        "type, unit, meaning and allowed values of every column",
        lambda tables: json.dumps(tables.codebook, indent=2, ensure_ascii=False),
    ),
}
TYPES: Final = {"csv": "text/csv; charset=utf-8", "json": "application/json"}


@router.get("/researcher/data", response_class=HTMLResponse)
def data(here: Here, researcher: ResearcherHere) -> Response:
    """Offer the tables."""
    study = here.study()
    tables = export.tables(here.db, study)
    counts = {
        "ratings.csv": len(tables.ratings),
        "comparisons.csv": len(tables.comparisons),
        "participants.csv": len(tables.participants),
    }
    return here.page(
        "researcher/data.html",
        **frame(study, researcher, "/data", "Data"),
        files=[(name, meaning, counts.get(name)) for name, (meaning, _) in FILES.items()],
        simulated=int(tables.participants["simulated"].fillna(False).sum()),
        log=logbook.logged(here.db, study)[:20],
    )


@router.get("/researcher/data/{name}")
def download(here: Here, researcher: ResearcherHere, name: str) -> Response:
    """Send one table, the codebook, or everything in one archive."""
    study = here.study()
    stem = f"{study.key}-{study.version}"
    if name not in FILES and name != "all.zip":
        raise HTTPException(404)
    tables = export.tables(here.db, study)
    logbook.log(here.db, researcher.researcher, "downloaded", study=study, payload={"file": name})
    if name == "all.zip":
        return _attachment(_archive(study, tables), "application/zip", f"{stem}.zip")
    body = FILES[name][1](tables).encode()
    return _attachment(body, TYPES[name.rpartition(".")[2]], f"{stem}-{name}")


def _archive(study: Study, tables: Tables) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, (_, write) in FILES.items():
            archive.writestr(name, write(tables))
        archive.writestr("study.json", json.dumps(json.loads(study.definition.to_json()), indent=2))
    return buffer.getvalue()


def _attachment(body: bytes, media_type: str, name: str) -> Response:
    disposition = f'attachment; filename="{name}"'
    return Response(body, media_type=media_type, headers={"Content-Disposition": disposition})
