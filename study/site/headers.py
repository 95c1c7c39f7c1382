"""Headers of every answer, and the refusal of posts that come from other sites' pages.

Plain ASGI: it knows nothing of pages, people or data.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

# Only this site's own files; blob: for clips that were preloaded. No inline script or style runs.
POLICY: Final = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self'",
        "media-src 'self' blob:",
        "connect-src 'self'",
        "form-action 'self'",
        "base-uri 'none'",
        "frame-ancestors 'none'",
    )
)
HEADERS: Final = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    # A personal link must not travel to other sites; "no-referrer" would also blank our own Origin.
    "Referrer-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
    "Cache-Control": "no-store",
}
_RAW: Final = tuple((name.lower().encode(), value.encode()) for name, value in HEADERS.items())
# The longest questionnaire stays far below; more would only fill the memory.
MAX_BODY_BYTES: Final = 1024 * 1024
SAFE_METHODS: Final = {"GET", "HEAD", "OPTIONS"}


class SecureHeaders:
    """Add HEADERS to every answer that lacks them; refuse foreign posts and endless bodies."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = completed(message.get("headers", ()))
            await send(message)

        if scope["method"] not in SAFE_METHODS and is_foreign(Headers(scope=scope)):
            refusal = PlainTextResponse("This request came from another site.", status_code=403)
            await refusal(scope, receive, send_with_headers)
            return
        await self.app(scope, limited(receive), send_with_headers)


def completed(given: Iterable[tuple[bytes, bytes]]) -> list[tuple[bytes, bytes]]:
    """Return an answer's headers with those of HEADERS that it lacks."""
    headers = list(given)
    names = {name.lower() for name, _ in headers}
    return headers + [pair for pair in _RAW if pair[0] not in names]


def limited(receive: Receive) -> Receive:
    """Let at most MAX_BODY_BYTES of a body through; more is answered with 413."""
    received = 0

    async def receive_some() -> Message:
        nonlocal received
        message = await receive()
        received += len(message.get("body", b""))
        if received > MAX_BODY_BYTES:
            raise HTTPException(413)
        return message

    return receive_some


def is_foreign(headers: Headers) -> bool:
    """Say whether a browser sent this from a page of another site.

    Browsers name the page's origin with every post; programs that name none are no one's browser,
    and carry no one's cookie unawares.
    """
    origin = headers.get("origin")
    if origin is None:
        return False
    return urlsplit(origin).netloc != headers.get("host", "")
