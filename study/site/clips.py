"""Files that never change under their names: clips by their hash, static files by their version."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from fastapi import APIRouter, HTTPException
from fastapi.responses import FileResponse, Response

from study.site.place import Here

router = APIRouter()
FOR_EVER: Final = {"Cache-Control": "public, max-age=31536000, immutable"}
# Clips are rendered in the study file's order: the time of a file would tell its condition.
ALWAYS_THE_SAME: Final = "Thu, 01 Jan 1970 00:00:00 GMT"
TYPES: Final = {".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}


@router.get("/clips/{name}.mp4")
@router.head("/clips/{name}.mp4", include_in_schema=False)
def clip(here: Here, name: str) -> Response:
    """Serve a clip, whole or by byte ranges (Safari plays nothing without them)."""
    path = here.clips.file(name)
    if path is None:
        raise HTTPException(404)
    headers = {**FOR_EVER, "ETag": f'"{name}"', "Last-Modified": ALWAYS_THE_SAME}
    return FileResponse(path, media_type="video/mp4", headers=headers)


@router.get("/static/{version}/{name}")
def static(here: Here, version: str, name: str) -> Response:
    """Serve a style sheet, script or icon; an old version's name gets the present file, unkept."""
    path = here.static_folder / Path(name).name
    if path.suffix not in TYPES or not path.is_file():
        raise HTTPException(404)
    headers = FOR_EVER if version == here.static_version else {}
    return FileResponse(path, media_type=TYPES[path.suffix], headers=headers)
