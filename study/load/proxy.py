"""A way to a site on which connections break where they are told to."""

from __future__ import annotations

import asyncio
import contextlib
from dataclasses import dataclass, field
from typing import Literal

Cut = Literal["request", "unheard", "answer"]
"""In the middle of the request; after it, before any answer; in the middle of the answer."""


@dataclass
class Proxy:
    """Passes one browser's connections on to a local port. ``cut`` breaks the next exchange."""

    to_port: int
    cut: Cut | None = None
    port: int = 0
    done: int = 0
    _server: asyncio.Server | None = None
    _open: set[asyncio.Task[None]] = field(default_factory=set)

    async def __aenter__(self) -> Proxy:
        self._server = await asyncio.start_server(self._accept, "127.0.0.1", 0)
        self.port = self._server.sockets[0].getsockname()[1]
        return self

    async def __aexit__(self, *_: object) -> None:
        if self._server is not None:
            self._server.close()
        for task in self._open:
            task.cancel()
        await asyncio.gather(*self._open, return_exceptions=True)

    async def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        if task is not None:
            self._open.add(task)
        there: asyncio.StreamWriter | None = None
        try:
            with contextlib.suppress(OSError):
                answers, there = await asyncio.open_connection("127.0.0.1", self.to_port)
                await self._exchanges((reader, writer), (answers, there))
        finally:
            for end in (writer, there):
                if end is not None:
                    end.transport.abort()  # at once: what is left unsent is lost, as in life
            if task is not None:
                self._open.discard(task)

    async def _exchanges(
        self,
        here: tuple[asyncio.StreamReader, asyncio.StreamWriter],
        there: tuple[asyncio.StreamReader, asyncio.StreamWriter],
    ) -> None:
        """Pass on what comes from either side until one ends or the cut is made."""
        (reader, writer), (answers, requests) = here, there
        asking = asyncio.create_task(reader.read(1 << 20))
        hearing = asyncio.create_task(answers.read(1 << 20))
        try:
            while True:
                await asyncio.wait([asking, hearing], return_when=asyncio.FIRST_COMPLETED)
                if asking.done():
                    data = asking.result()
                    cut = self.cut if data else None
                    requests.write(data[: len(data) // 2] if cut == "request" else data)
                    if not data or self._is_made("request"):
                        return
                    asking = asyncio.create_task(reader.read(1 << 20))
                if hearing.done():
                    data = hearing.result()
                    if not data or self._is_made("unheard"):
                        return
                    writer.write(data[: len(data) // 2] if self.cut == "answer" else data)
                    if self._is_made("answer"):
                        return
                    hearing = asyncio.create_task(answers.read(1 << 20))
        finally:
            asking.cancel()
            hearing.cancel()

    def _is_made(self, cut: Cut) -> bool:
        if self.cut != cut:
            return False
        self.cut = None
        self.done += 1
        return True
