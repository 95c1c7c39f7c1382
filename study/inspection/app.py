"""The page and its pictures. Frames come from a renderer that one thread owns."""

from __future__ import annotations

import asyncio
import io
import json
import logging
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager
from typing import Annotated, Final, Protocol

import numpy as np
import numpy.typing as npt
from fastapi import FastAPI, Query, Request
from fastapi.responses import HTMLResponse, PlainTextResponse, Response
from fastapi.staticfiles import StaticFiles
from fastapi.templating import Jinja2Templates
from PIL import Image
from starlette.middleware.trustedhost import TrustedHostMiddleware

from renderer.camera import IRIS_PX
from renderer.clip import ClipSpec
from renderer.detail import EFFECTS, LEVELS
from renderer.lod.choice import SWITCHINGS, LodPolicy
from study.inspection.look import LARGEST_PX, STEEPEST_DEG, Look
from study.site.headers import SecureHeaders
from study.site.resources import resource_folder

log = logging.getLogger("ocularist.inspect")
QUALITY: Final = 92  # of the JPEG: a look, no stimulus


class Picture(Protocol):
    """A frame (height, width, 3) uint8 and what the page tells about it."""

    @property
    def pixels(self) -> npt.NDArray[np.uint8]: ...

    @property
    def facts(self) -> dict[str, object]: ...


class Draughtsman(Protocol):
    """What draws, always in the one thread that made it."""

    @property
    def gl_renderer(self) -> str: ...

    def shot(self, spec: ClipSpec, look: Look) -> Picture:
        """Draw the eyes."""
        ...

    def overhead(self, spec: ClipSpec, look: Look) -> Picture:
        """Draw the whole scene from above."""
        ...

    def close(self) -> None:
        """Give back what it holds."""
        ...


def create_inspection(
    base: ClipSpec,
    make: Callable[[], Draughtsman],
    *,
    policy: LodPolicy,
    first: Look,
    hosts: tuple[str, ...],
) -> FastAPI:
    """Build the page's application.

    ``base`` holds what the page leaves alone; ``make`` is called once, in the thread that draws;
    eyes that switch do so by ``policy``; ``first`` is what the page shows first. ``hosts`` are the
    names under which the page may be asked for: no other site's page can reach in under a name of
    its own.
    """
    thread = ThreadPoolExecutor(1, thread_name_prefix="inspect")
    held: list[Draughtsman] = []

    def draughtsman() -> Draughtsman:
        if not held:
            held.append(make())
        return held[0]

    @asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        yield
        if held:
            thread.submit(held[0].close).result()
        thread.shutdown()

    app = FastAPI(title="Ocularist inspect", openapi_url=None, lifespan=lifespan)
    app.add_middleware(SecureHeaders)
    app.add_middleware(TrustedHostMiddleware, allowed_hosts=list(hosts))
    app.mount("/static", StaticFiles(directory=resource_folder("static")))
    templates = Jinja2Templates(directory=resource_folder("templates"))

    async def drawn(draw: Callable[[Draughtsman], Picture]) -> Response:
        try:
            picture = await asyncio.get_running_loop().run_in_executor(
                thread, lambda: draw(draughtsman())
            )
        except asyncio.CancelledError:  # the server stops: nobody waits for this picture
            return PlainTextResponse("The command has been stopped.", status_code=503)
        except Exception as error:
            log.exception("no picture")
            return PlainTextResponse(f"{type(error).__name__}: {error}", status_code=500)
        file = io.BytesIO()
        Image.fromarray(picture.pixels).save(file, "JPEG", quality=QUALITY, subsampling=0)
        facts = json.dumps(picture.facts)
        return Response(file.getvalue(), media_type="image/jpeg", headers={"X-Inspect": facts})

    @app.get("/")
    async def page(request: Request) -> HTMLResponse:
        start = {
            "first": first.model_dump(exclude={"divide"}),
            "levels": LEVELS,
            "switchings": SWITCHINGS,
            "distances": sorted(IRIS_PX.values(), reverse=True),
            "largest": LARGEST_PX,
            "steepest": STEEPEST_DEG,
            "size": [base.width, base.height],
        }
        context = {
            "start": start,
            "effects": EFFECTS,
            "levels": LEVELS,
            "switchings": SWITCHINGS,
        }
        return templates.TemplateResponse(request, "inspect/page.html", context)

    @app.get("/frame")
    async def frame(look: Annotated[Look, Query()]) -> Response:
        return await drawn(lambda who: who.shot(look.spec(base, policy), look))

    @app.get("/overhead")
    async def overhead(look: Annotated[Look, Query()]) -> Response:
        return await drawn(lambda who: who.overhead(look.spec(base, policy), look))

    return app
