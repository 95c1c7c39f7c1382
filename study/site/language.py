"""In which language a page is shown: by link, by an earlier choice, or as the browser prefers.

Whoever takes part keeps the language in which they agreed; it is stored with them.
"""

from __future__ import annotations

from typing import Annotated, Final

from fastapi import Depends, Request, Response

from study.data.studies import Study
from study.texts import first_spoken, wished_in_header

LANGUAGE_COOKIE: Final = "ocularist_language"
LONGEST_TAG: Final = 20


def wishes_of(request: Request) -> tuple[str, ...]:
    """Return the languages that whoever asks wishes for, best first: link, choice, browser."""
    chosen = (request.query_params.get("lang", ""), request.cookies.get(LANGUAGE_COOKIE, ""))
    browsers = wished_in_header(request.headers.get("accept-language", ""))
    return tuple(wish for wish in (*chosen, *browsers) if 0 < len(wish) <= LONGEST_TAG)


Wishes = Annotated[tuple[str, ...], Depends(wishes_of)]


def language_of(study: Study, wishes: tuple[str, ...]) -> str:
    """Return the language of a study that serves these wishes best."""
    return first_spoken(wishes, study.languages) or study.definition.language


def remember_language(response: Response, language: str) -> None:
    """Keep a choice of language in this browser until it is closed."""
    response.set_cookie(LANGUAGE_COOKIE, language, httponly=True, samesite="lax")
