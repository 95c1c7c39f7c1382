"""What an error is answered with: one table, whichever way a request took through the site.

A script is told in JSON and a person in a calm page; the cause is in the log.
"""

from __future__ import annotations

import logging
import secrets
from collections.abc import Callable, Mapping
from typing import Any, Final

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.exceptions import HTTPException

from study.data.refusals import RefusedError, TooManyError, WithdrawnError
from study.site.access import ElsewhereError, ForgedError
from study.site.place import NoStudyError
from study.site.problems import problem_page

log = logging.getLogger("ocularist.site")
FOR_SCRIPTS: Final = ("/events", "/preparing/state")
Answer = Callable[[Request, Any], Response]


def handle_errors(app: FastAPI) -> None:
    """Answer every error of an application as the table says."""
    for kind in ANSWERS:
        app.add_exception_handler(kind, _handled)


def answer_error(request: Request, error: Exception) -> Response:
    """Return the answer to an error: that of the nearest kind in the table."""
    kind = next(kind for kind in type(error).__mro__ if kind in ANSWERS)
    return ANSWERS[kind](request, error)


def is_foreseen(error: Exception) -> bool:
    """Say whether the table knows more of an error than that it is one."""
    return any(kind in ANSWERS for kind in type(error).__mro__ if kind is not Exception)


async def _handled(request: Request, error: Exception) -> Response:
    return answer_error(request, error)


def _elsewhere(request: Request, error: ElsewhereError) -> Response:
    if request.url.path in FOR_SCRIPTS:  # a script must not take another page for a "yes"
        return _told(request, 401, "NOT-SIGNED-IN")
    return RedirectResponse(error.url, status_code=303)


def _withdrawn(request: Request, _error: WithdrawnError) -> Response:
    if request.url.path in FOR_SCRIPTS:
        return _told(request, 410, "WITHDRAWN")
    return RedirectResponse("/withdrawn", status_code=303)


def _too_many(request: Request, error: TooManyError) -> Response:
    answer = _told(request, 429, "TOO-MANY")
    answer.headers["Retry-After"] = str(error.wait_s)
    return answer


def _refused(request: Request, error: RefusedError) -> Response:
    log.info("refused: %s", error)
    return _told(request, 409, "OUT-OF-STEP")


def _http(request: Request, error: HTTPException) -> Response:
    return _told(request, error.status_code, f"PAGE-{error.status_code}")


def _broken(request: Request, error: Exception) -> Response:
    code = f"SITE-{secrets.token_hex(3).upper()}"
    log.error("%s: %s %s", code, request.method, request.url.path, exc_info=error)
    return _told(request, 500, code)


ANSWERS: Final[Mapping[type, Answer]] = {
    ElsewhereError: _elsewhere,
    ForgedError: lambda request, _error: _told(request, 403, "FORM-OLD"),
    WithdrawnError: _withdrawn,
    TooManyError: _too_many,
    RefusedError: _refused,
    NoStudyError: lambda request, _error: _told(request, 503, "NO-STUDY"),
    RequestValidationError: lambda request, _error: _told(request, 422, "NOT-READABLE"),
    HTTPException: _http,
    Exception: _broken,
}


def _told(request: Request, status: int, code: str) -> Response:
    if request.url.path in FOR_SCRIPTS:
        return JSONResponse({"code": code}, status_code=status)
    if request.url.path.startswith(("/static/", "/clips/")):
        return PlainTextResponse(code, status_code=status)
    return problem_page(request, status=status, code=code)
