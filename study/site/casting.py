"""Pages that are cast: rendered once, then filled with what is one visitor's own.

What a page says follows from the study, its language and a few facts that its template asks about;
for each of these there is a mould (``study.site.mould``).
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import replace
from typing import Any

from fastapi.responses import HTMLResponse

from study.data.studies import Study
from study.site.access import Visitor
from study.site.frame import shared, spoken_with
from study.site.mould import place
from study.site.place import Place
from study.texts import catalogue

Frame = dict[str, Any]


def cast_page(
    here: Place,
    study: Study,
    visitor: Visitor | None,
    page: str,
    *,
    own: Mapping[str, object],
    wishes: tuple[str, ...] = (),
    asked: tuple[Hashable, ...] = (),
    fixed: Callable[[Frame], Mapping[str, Any]],
) -> HTMLResponse:
    """Return the page ``participant/PAGE.html`` for a visitor, or for nobody with these wishes.

    ``own`` is printed as it stands. Everything else follows from the study and from what the
    template has ``asked`` about: ``fixed`` returns it, given the frame, when a mould is made.
    """
    words = catalogue(spoken_with(study, visitor, wishes))

    def rendered() -> str:
        blank = None if visitor is None else blank_visitor(visitor)
        frame = shared(study, blank, page, wishes=wishes)
        places = {name: place(name) for name in own}
        template = here.pages.get_template(f"participant/{page}.html")
        return template.render({**frame, **fixed(frame), **places})

    who = () if visitor is None else (visitor.is_simulated, visitor.is_over)
    name = (page, words.tongue.language, *who, *asked)
    mould = here.parts.of(study.definition, words.markup).moulds.of(name, rendered)
    return HTMLResponse(mould.fill({**own, **({} if visitor is None else visitors_own(visitor))}))


def blank_visitor(visitor: Visitor) -> Visitor:
    """Return a visitor for a mould, with places for what is nobody else's.

    They have no token, so that nothing in a mould can be the personal link of whom it was made for.
    """
    nobody = replace(visitor.participant, public_id=place("name"))
    return replace(
        visitor, participant=nobody, token="", csrf=place("csrf"), outbox=place("outbox")
    )


def visitors_own(visitor: Visitor) -> dict[str, object]:
    """Return what stands at the places of ``blank_visitor``."""
    return {"name": visitor.name, "csrf": visitor.csrf, "outbox": visitor.outbox}
