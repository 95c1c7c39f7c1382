"""What every page of a participant shows around its own content."""

from __future__ import annotations

from typing import Any

from study.data.studies import Study
from study.site.access import Visitor


def shared(study: Study, visitor: Visitor | None, page: str) -> dict[str, Any]:
    """Return what every page of a participant shows."""
    return {
        "page": page,
        "visitor": visitor,
        "study_title": study.title,
        "language": study.definition.language,
        "contact": study.definition.contact,
        "resume_url": visitor.resume_url if visitor else "",
    }
