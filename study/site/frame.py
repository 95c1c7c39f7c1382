"""What every page of a participant shows around its own content, and in which language."""

from __future__ import annotations

from typing import Any

from study.data.participants import IDLE
from study.data.studies import Study
from study.site.access import Visitor
from study.site.language import language_of
from study.texts import Catalogue, catalogue, tongue


def shared(
    study: Study, visitor: Visitor | None, page: str, *, wishes: tuple[str, ...] = ()
) -> dict[str, Any]:
    """Return what every page of a participant shows.

    ``text`` is the catalogue in the participant's language, for a visitor who takes part; others
    get one of their ``wishes``. ``page`` names the page and the script that serves it.
    """
    language = spoken_with(study, visitor, wishes)
    words = catalogue(language)
    return {
        "page": page,
        "visitor": visitor,
        "study_title": study.title,
        "language": language,
        "direction": tongue(language).direction,
        "languages": [tongue(one) for one in study.languages],
        "text": words.markup,
        "script_texts": words.of_scripts(page),
        "contact": study.definition.contact,
        "release_s": int(IDLE.total_seconds()),
        "resume_url": visitor.resume_url if visitor else "",
    }


def words_of(study: Study, visitor: Visitor) -> Catalogue:
    """Return the catalogue of somebody who takes part."""
    return catalogue(spoken_with(study, visitor))


def spoken_with(study: Study, visitor: Visitor | None, wishes: tuple[str, ...] = ()) -> str:
    """Return the language of a page."""
    return language_of(study, (visitor.participant.language,) if visitor else wishes)
