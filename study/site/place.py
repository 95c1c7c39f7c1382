"""What one running site consists of: settings, database, study, pages, clips."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import jinja2
from fastapi import Depends, Request
from fastapi.responses import HTMLResponse

from study.data import limits, studies
from study.data.database import Database
from study.data.studies import Study
from study.data.writer import Writer
from study.settings import Settings
from study.site.media import ClipShelf
from study.site.pace import Pace
from study.site.parts import PartsShelf
from study.site.resources import folder_version, resource_folder
from study.site.signatures import who_hash
from study.texts import first_spoken


class NoStudyError(LookupError):
    """The database holds no study yet."""


@dataclass
class Place:
    """One site. ``study_id`` is the study that newcomers take part in; None: the latest."""

    settings: Settings
    db: Database
    study_id: int | None
    clips: ClipShelf
    secret: str
    static_folder: Path = field(default_factory=lambda: resource_folder("static"))

    def __post_init__(self) -> None:
        self.static_version = folder_version(self.static_folder)
        self.pages = _environment(self.static_version)
        self.parts = PartsShelf(self.pages)
        self.writer = Writer(self.db)
        self.pace = Pace(self._count_reports)

    def study(self, wishes: Sequence[str] = ()) -> Study:
        """Return the study that newcomers take part in, in the language that serves them best."""
        found = self._study()
        language = first_spoken(wishes, found.languages)
        return found.spoken(language or found.definition.language)

    def _study(self) -> Study:
        if self.study_id is not None:
            return studies.by_id(self.db, self.study_id)
        found = studies.latest(self.db)
        if found is None:
            raise NoStudyError("there is no study in this database yet; start: ocularist run")
        return found

    def _count_reports(self, name: str, times: int) -> None:
        who = who_hash(self.secret, name)
        limits.count(self.db, limits.REPORTING, who, times=times)

    def page(self, template: str, *, status: int = 200, **values: Any) -> HTMLResponse:
        """Render a template into a page."""
        return HTMLResponse(self.pages.get_template(template).render(values), status_code=status)

    def warm_up(self) -> None:
        """Compile every page now: the first of a crowd would do so at once in many threads."""
        for name in self.pages.list_templates():
            self.pages.get_template(name)


def _environment(version: str) -> jinja2.Environment:
    pages = jinja2.Environment(
        loader=jinja2.FileSystemLoader(resource_folder("templates")),
        autoescape=True,
        # They change with the program alone; asking the disk would cost as much as half a page.
        auto_reload=False,
        # A name that is missing in a template is a fault of ours, not an empty place on the page.
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    # The version in the path changes with the files: browsers may keep them for ever.
    pages.globals["static"] = lambda name: f"/static/{version}/{name}"
    return pages


def place_in(request: Request) -> Place:
    """Return the site that a request came to."""
    found: Place = request.app.state.place
    return found


async def place_of(request: Request) -> Place:
    """Return the same as a dependency."""
    return place_in(request)


Here = Annotated[Place, Depends(place_of)]
