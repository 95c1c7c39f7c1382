"""The requests that come most, answered past the framework: the whole way of a participant.

Its layers cost as much as storing an answer does. What is asked, the errors and the headers are
the same as through them, because both ways lead to the same functions; and whatever is not quite
ordinary (a query, another site's page, a path that no number ends) takes the longer way.

It is no second framework: one table of paths, no parameters but a trial's number, nothing that a
function could not do with the request alone.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from functools import partial
from typing import Final

from fastapi import FastAPI, Request
from fastapi.responses import Response
from starlette.types import Receive, Scope, Send

from study.site import (
    about,
    calibration,
    consent,
    device_check,
    ending,
    eyesight,
    news,
    preparing,
    trial,
    way,
)
from study.site.errors import answer_error, is_foreseen
from study.site.headers import completed, is_foreign, limited
from study.site.language import LANGUAGE_FIELD

Act = Callable[[Request], Awaitable[Response]]
TRIAL: Final = "/trial/"
MOST_DIGITS: Final = 6
_TRIAL_ACTS: Final = {"GET": trial.trial, "POST": trial.finish}
_ACTS: Final[Mapping[tuple[str, str], Act]] = {
    ("POST", "/events"): news.report,
    ("GET", "/consent"): consent.consent,
    ("POST", "/consent"): consent.agree,
    ("GET", "/continue"): way.lead,
    ("GET", "/about-you"): about.about,
    ("POST", "/about-you"): about.store_about,
    ("GET", "/device-check"): device_check.show,
    ("POST", "/device-check"): device_check.store,
    ("GET", "/calibration"): calibration.show,
    ("POST", "/calibration"): calibration.store,
    ("GET", "/eyesight"): eyesight.show,
    ("POST", "/eyesight"): eyesight.store,
    ("GET", "/instructions"): about.instructions,
    ("POST", "/instructions"): about.read_instructions,
    ("GET", "/preparing"): preparing.preparing,
    ("POST", "/preparing"): preparing.begin,
    ("GET", "/thanks"): ending.thanks,
}
_ASKED: Final[Mapping[tuple[str, str], Act]] = {("GET", "/preparing/state"): preparing.asked_state}
"""What is asked with a query."""


class Express(FastAPI):
    """An application with a short way for what comes most."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or let the framework do so."""
        act = wanted(scope)
        if act is None:
            await super().__call__(scope, receive, send)
            return
        scope["app"] = self
        request = Request(scope, limited(receive))
        if is_foreign(request.headers):
            await super().__call__(scope, receive, send)
            return
        await _answer(act, request, send)


def wanted(scope: Scope) -> Act | None:
    """Return what answers a request the short way; None for any other."""
    if scope["type"] != "http" or scope.get("root_path"):
        return None
    path, method, query = scope["path"], scope["method"], scope["query_string"]
    if query:  # another language is remembered on the longer way
        return None if LANGUAGE_FIELD.encode() in query else _ASKED.get((method, path))
    if act := _ACTS.get((method, path)):
        return act
    if not path.startswith(TRIAL) or method not in _TRIAL_ACTS:
        return None
    number = path[len(TRIAL) :]
    if not (number.isascii() and number.isdecimal() and len(number) <= MOST_DIGITS):
        return None
    return partial(_TRIAL_ACTS[method], position=int(number))


async def _answer(act: Act, request: Request, send: Send) -> None:
    """Send what comes of a request; what was not foreseen the server's log shall have too."""
    broken: Exception | None = None
    try:
        response = await act(request)
    except Exception as error:
        response = answer_error(request, error)
        broken = None if is_foreseen(error) else error
    headers = completed(response.raw_headers)
    start = {"type": "http.response.start", "status": response.status_code, "headers": headers}
    await send(start)
    await send({"type": "http.response.body", "body": response.body})
    if broken is not None:
        raise broken
