"""One connection to a site: just enough HTTP/1.1 for a crowd, at a fraction of a client's cost.

It keeps its connection open and its cookies, and follows no redirect by itself. A broken
connection is an OSError; the next request opens another.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final
from urllib.parse import urlencode, urlsplit

TIMEOUT_S: Final = 30.0
IDLE_S: Final = 3.0  # what lies idle for longer the server closes (uvicorn after 5 s)


class BrokenError(OSError):
    """The connection ended before a whole answer had come."""


@dataclass(frozen=True)
class Answered:
    """A whole answer; header names are in lower case."""

    status: int
    headers: Mapping[str, str]
    body: bytes

    @property
    def text(self) -> str:
        """The body as text."""
        return self.body.decode("utf-8", "replace")


@dataclass
class Wire:
    """A connection to one site, with one browser's cookies."""

    url: str
    headers: Mapping[str, str] = field(default_factory=dict)
    timeout_s: float = TIMEOUT_S
    cookies: dict[str, str] = field(default_factory=dict)
    _used: float = 0.0
    _streams: tuple[asyncio.StreamReader, asyncio.StreamWriter] | None = None

    async def get(self, path: str) -> Answered:
        """Send a GET."""
        return await self.request("GET", path)

    async def post_form(self, path: str, fields: Mapping[str, object]) -> Answered:
        """Send a form."""
        body = urlencode(fields, doseq=True).encode()
        return await self.request(
            "POST", path, body=body, headers={"Content-Type": "application/x-www-form-urlencoded"}
        )

    async def request(
        self,
        method: str,
        path: str,
        *,
        body: bytes = b"",
        headers: Mapping[str, str] | None = None,
    ) -> Answered:
        """Send a request and read the whole answer; raises OSError when there is none."""
        try:
            async with asyncio.timeout(self.timeout_s):
                return await self._exchange(self._head(method, path, body, headers or {}) + body)
        except (EOFError, ValueError) as error:
            self.close()
            raise BrokenError(f"{method} {path}: {error}") from None
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close the connection; the cookies stay."""
        if self._streams is not None:
            self._streams[1].transport.abort()
            self._streams = None

    def _head(self, method: str, path: str, body: bytes, headers: Mapping[str, str]) -> bytes:
        lines = [f"{method} {path} HTTP/1.1", f"Host: {urlsplit(self.url).netloc}"]
        lines += [f"{name}: {value}" for name, value in {**self.headers, **headers}.items()]
        if self.cookies:
            lines.append("Cookie: " + "; ".join(f"{n}={v}" for n, v in self.cookies.items()))
        if body or method == "POST":
            lines.append(f"Content-Length: {len(body)}")
        return "\r\n".join([*lines, "", ""]).encode()

    async def _exchange(self, request: bytes) -> Answered:
        if time.monotonic() - self._used > IDLE_S:
            self.close()
        if self._streams is None:
            where = urlsplit(self.url)
            self._streams = await asyncio.open_connection(where.hostname, where.port)
        reader, writer = self._streams
        writer.write(request)
        first, *lines = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")
        headers: dict[str, str] = {}
        for line in lines:
            name, _, value = line.partition(":")
            if name.lower() == "set-cookie":
                self._keep(value.strip())
            elif name:
                headers[name.lower()] = value.strip()
        body = await _body(reader, headers)
        self._used = time.monotonic()
        if headers.get("connection") == "close":
            self.close()
        return Answered(int(first.split(" ", 2)[1]), headers, body)

    def _keep(self, cookie: str) -> None:
        name, _, value = cookie.split(";", 1)[0].partition("=")
        if value.strip('"'):
            self.cookies[name] = value
        else:
            self.cookies.pop(name, None)


async def _body(reader: asyncio.StreamReader, headers: Mapping[str, str]) -> bytes:
    if headers.get("transfer-encoding", "").lower() != "chunked":
        return await reader.readexactly(int(headers.get("content-length", "0")))
    parts = []
    while size := int((await reader.readuntil(b"\r\n")).split(b";")[0], 16):
        parts.append((await reader.readexactly(size + 2))[:-2])
    await reader.readuntil(b"\r\n")
    return b"".join(parts)
