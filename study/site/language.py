"""In which language a page is shown: by link, by an earlier choice, or as the browser prefers.

Whoever takes part keeps the language in which they agreed; it is stored with them.
"""

from __future__ import annotations

import re
from http.cookies import SimpleCookie
from typing import Annotated, Final

from fastapi import Depends, Request
from starlette.datastructures import MutableHeaders, QueryParams
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from study.data.studies import Study
from study.texts import first_spoken, wished_in_header

LANGUAGE_COOKIE: Final = "ocularist_language"
LANGUAGE_FIELD: Final = "lang"
_TAG: Final = re.compile(r"[A-Za-z]{2,8}(-[A-Za-z0-9]{1,8}){0,2}")


def wishes_of(request: Request) -> tuple[str, ...]:
    """Return the languages that whoever asks wishes for, best first: link, choice, browser."""
    chosen = request.query_params.get(LANGUAGE_FIELD, ""), request.cookies.get(LANGUAGE_COOKIE, "")
    browsers = wished_in_header(request.headers.get("accept-language", ""))
    return tuple(wish for wish in (*chosen, *browsers) if _TAG.fullmatch(wish))


Wishes = Annotated[tuple[str, ...], Depends(wishes_of)]


def language_of(study: Study, wishes: tuple[str, ...]) -> str:
    """Return the language of a study that serves these wishes best."""
    return first_spoken(wishes, study.languages) or study.definition.language


class RememberLanguage:
    """Keep the language of a link, ``?lang=ar``, in its browser until that is closed.

    Here and not on a page: such a link may be answered with the way to another page.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, and add the cookie to its answer if the link names a language."""
        query = QueryParams(scope.get("query_string", b"")) if scope["type"] == "http" else {}
        chosen = query.get(LANGUAGE_FIELD, "")
        if not _TAG.fullmatch(chosen):
            await self.app(scope, receive, send)
            return

        async def send_with_cookie(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).append("Set-Cookie", _cookie(chosen))
            await send(message)

        await self.app(scope, receive, send_with_cookie)


def _cookie(language: str) -> str:
    cookie = SimpleCookie({LANGUAGE_COOKIE: language})
    for name, value in (("path", "/"), ("samesite", "lax"), ("httponly", "1")):
        cookie[LANGUAGE_COOKIE][name] = value
    return cookie[LANGUAGE_COOKIE].OutputString()
