"""Calm pages for what went wrong: a sentence, a next step and a code; the cause is in the log."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from fastapi import Request
from fastapi.responses import HTMLResponse

from study.design.texts import Contact
from study.site.headers import HEADERS
from study.site.place import NoStudyError, Place


@dataclass(frozen=True)
class Words:
    """What a problem page says."""

    heading: str
    sentence: str
    step: str = ""
    link: str = "Go on"
    href: str = "/continue"


WORDS: Final = {
    "FORM-OLD": Words(
        "Please send that again",
        "The page had become too old to be sent.",
        "Go back to where you are and send it once more. Your earlier answers are safe.",
    ),
    "OUT-OF-STEP": Words(
        "This page is not next",
        "That belongs to another part of the study.",
        "We take you to where you are. Your answers are safe.",
    ),
    "NO-STUDY": Words(
        "No study is running here yet",
        "Please come back a little later.",
        link="Try again",
        href="/",
    ),
    "NOT-READABLE": Words(
        "We could not read that",
        "What your browser sent was incomplete.",
        "Go back to where you are and try once more.",
    ),
    "PAGE-404": Words(
        "There is no such page",
        "The address may be mistyped or no longer in use.",
        link="To the first page",
        href="/",
    ),
    "CLIP-MISSING": Words(
        "This clip is not ready",
        "The clip that comes next cannot be shown at the moment. Your answers so far are safe.",
        "Please wait a minute and try again. You may also come back later; your place is kept.",
        link="Try again",
    ),
}
REFUSED: Final = Words(
    "That did not work",
    "Your browser sent something that this page does not take. Your answers so far are safe.",
    "Go back to where you are and try once more.",
)
OUR_FAULT: Final = Words(
    "Something went wrong",
    "That was our fault, not yours. Your answers so far are safe.",
    "Please try again in a moment.",
    link="Try again",
)


def problem_page(request: Request, *, status: int, code: str) -> HTMLResponse:
    """Return the calm page for a code."""
    place: Place = request.app.state.place
    words = WORDS.get(code.partition(" ")[0], OUR_FAULT if status >= 500 else REFUSED)
    try:
        definition = place.study().definition
        title, language, contact = definition.title, definition.language, definition.contact
    except NoStudyError:
        title, language, contact = "Ocularist", "en", Contact(name="the researcher who invited you")
    page = place.page(
        "participant/problem.html",
        status=status,
        page="problem",
        visitor=None,
        study_title=title,
        language=language,
        contact=contact,
        code=code,
        words=words,
    )
    # An unforeseen error is answered outside of the middleware that adds these.
    page.headers.update(HEADERS)
    return page
