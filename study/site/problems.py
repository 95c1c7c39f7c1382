"""Calm pages for what went wrong: a sentence, a next step and a code; the cause is in the log."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from fastapi import Request
from fastapi.responses import HTMLResponse

from study.design.texts import Contact
from study.site.frame import shared
from study.site.headers import HEADERS
from study.site.language import wishes_of
from study.site.place import NoStudyError, Place
from study.texts import catalogue, first_spoken, languages, tongue


@dataclass(frozen=True)
class Problem:
    """A page's texts, ``problem.NAME.*`` of the catalogue, and where its button leads."""

    name: str
    button: str = "go_on"
    href: str = "/continue"


PROBLEMS: Final = {
    "FORM-OLD": Problem("form_old"),
    "OUT-OF-STEP": Problem("out_of_step"),
    "TOO-MANY": Problem("too_many", "try_again"),
    "NO-STUDY": Problem("no_study", "try_again", "/"),
    "NOT-READABLE": Problem("not_readable"),
    "PAGE-404": Problem("page_404", "first_page", "/"),
    "CLIP-MISSING": Problem("clip_missing", "try_again"),
    "LINK-UNKNOWN": Problem("link_unknown", "first_page", "/"),
    "LINK-USED": Problem("link_used", "first_page", "/"),
}
REFUSED: Final = Problem("refused")
OUR_FAULT: Final = Problem("our_fault", "try_again")


def problem_page(request: Request, *, status: int, code: str) -> HTMLResponse:
    """Return the calm page for a code."""
    place: Place = request.app.state.place
    problem = PROBLEMS.get(code.partition(" ")[0], OUR_FAULT if status >= 500 else REFUSED)
    frame = _frame(request, place)
    text = frame["text"]
    page = place.page(
        "participant/problem.html",
        status=status,
        **frame,
        code=code,
        heading=text(f"problem.{problem.name}.heading"),
        sentence=text(f"problem.{problem.name}.sentence"),
        step=text(f"problem.{problem.name}.step"),
        button=text(f"problem.{problem.button}"),
        href=problem.href,
    )
    # An unforeseen error is answered outside of the middleware that adds these.
    page.headers.update(HEADERS)
    return page


def _frame(request: Request, place: Place) -> dict[str, Any]:
    """Return what stands around the page; where there is no study, in words that need none."""
    wishes = wishes_of(request)
    try:
        return shared(place.study(wishes), None, "problem", wishes=wishes)
    except NoStudyError:
        words = catalogue(first_spoken(wishes, languages()) or languages()[0])
    return {
        "page": "problem",
        "visitor": None,
        "study_title": "Ocularist",
        "language": words.tongue.language,
        "direction": tongue(words.tongue.language).direction,
        "languages": [],
        "text": words.markup,
        "script_texts": words.of_scripts("problem"),
        "contact": Contact(name=words.text("problem.contact")),
        "resume_url": "",
    }
