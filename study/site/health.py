"""A sign of life for those who watch over the site: it answers, and its database does too."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from study.site.place import Here

router = APIRouter()


@router.get("/healthz")
def health(here: Here) -> dict[str, Any]:
    """Say "ok" after a question to the database; an error is answered with 500."""
    return {"ok": True, "study": here.study().key}
