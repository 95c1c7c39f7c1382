"""The site as an application, built from its settings."""

from __future__ import annotations

import logging
import secrets
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Final

from anyio import to_thread
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.exceptions import HTTPException

from study.data.database import open_database
from study.data.refusals import RefusedError, TooManyError, WithdrawnError
from study.settings import Settings
from study.site import (
    about,
    beginning,
    calibration,
    clips,
    consent,
    dashboard,
    device_check,
    door,
    downloads,
    ending,
    eyesight,
    gallery,
    health,
    invitations,
    leaving,
    news,
    pause,
    preparing,
    results,
    trial,
)
from study.site.access import ElsewhereError, ForgedError
from study.site.headers import SecureHeaders
from study.site.language import RememberLanguage
from study.site.media import ClipShelf
from study.site.place import NoStudyError, Place
from study.site.problems import problem_page

log = logging.getLogger("ocularist.site")
# Threads that answer requests. More of them only take the interpreter from each other, above all
# from the one that writes: with 40 a crowd was answered half as fast (docs/load.md).
THREADS: Final = 16
FOR_SCRIPTS = ("/events", "/preparing/state")
# In the order in which they are asked for a path: what comes most stands first.
ROOMS = (
    news,
    trial,
    beginning,
    invitations,
    consent,
    about,
    device_check,
    calibration,
    eyesight,
    preparing,
    pause,
    leaving,
    ending,
    clips,
    door,
    dashboard,
    gallery,
    health,
    results,
    downloads,
)


def create_app(settings: Settings, *, study_id: int | None = None) -> FastAPI:
    """Build the site.

    ``study_id`` names the study that newcomers take part in; without it the database's latest.
    People who have begun another one go on with theirs.
    """
    place = Place(
        settings=settings,
        db=open_database(settings.database_url),
        study_id=study_id,
        clips=ClipShelf(settings.media_folder),
        secret=settings.secret_key(),
    )

    @asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        to_thread.current_default_thread_limiter().total_tokens = THREADS
        yield
        place.writer.close()
        place.db.close()

    app = FastAPI(title="Ocularist", openapi_url=None, lifespan=lifespan)
    app.state.place = place
    app.add_middleware(RememberLanguage)
    app.add_middleware(SecureHeaders)
    for room in ROOMS:
        app.include_router(room.router)
    _handle_errors(app)
    return app


def _handle_errors(app: FastAPI) -> None:
    @app.exception_handler(ElsewhereError)
    async def lead(request: Request, error: ElsewhereError) -> Response:
        if request.url.path in FOR_SCRIPTS:  # a script must not take another page for a "yes"
            return _answer(request, 401, "NOT-SIGNED-IN")
        return RedirectResponse(error.url, status_code=303)

    @app.exception_handler(ForgedError)
    async def forged(request: Request, _error: ForgedError) -> Response:
        return _answer(request, 403, "FORM-OLD")

    @app.exception_handler(WithdrawnError)
    async def withdrawn(request: Request, _error: WithdrawnError) -> Response:
        if request.url.path in FOR_SCRIPTS:
            return _answer(request, 410, "WITHDRAWN")
        return RedirectResponse("/withdrawn", status_code=303)

    @app.exception_handler(TooManyError)
    async def too_many(request: Request, error: TooManyError) -> Response:
        answer = _answer(request, 429, "TOO-MANY")
        answer.headers["Retry-After"] = str(error.wait_s)
        return answer

    @app.exception_handler(RefusedError)
    async def refused(request: Request, error: RefusedError) -> Response:
        log.info("refused: %s", error)
        return _answer(request, 409, "OUT-OF-STEP")

    @app.exception_handler(NoStudyError)
    async def no_study(request: Request, _error: NoStudyError) -> Response:
        return _answer(request, 503, "NO-STUDY")

    @app.exception_handler(RequestValidationError)
    async def unreadable(request: Request, _error: RequestValidationError) -> Response:
        return _answer(request, 422, "NOT-READABLE")

    @app.exception_handler(HTTPException)
    async def http_error(request: Request, error: HTTPException) -> Response:
        return _answer(request, error.status_code, f"PAGE-{error.status_code}")

    @app.exception_handler(Exception)
    async def broken(request: Request, error: Exception) -> Response:
        code = f"SITE-{secrets.token_hex(3).upper()}"
        log.error("%s: %s %s", code, request.method, request.url.path, exc_info=error)
        return _answer(request, 500, code)


def _answer(request: Request, status: int, code: str) -> Response:
    """Tell a script in JSON and a person in a calm page what happened; the cause is in the log."""
    if request.url.path in FOR_SCRIPTS:
        return JSONResponse({"code": code}, status_code=status)
    if request.url.path.startswith(("/static/", "/clips/")):
        return PlainTextResponse(code, status_code=status)
    return problem_page(request, status=status, code=code)
