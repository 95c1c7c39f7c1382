"""The site as an application, built from its settings."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Final

from anyio import to_thread
from fastapi import FastAPI

from study.data.database import open_database
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
    way,
)
from study.site.errors import handle_errors
from study.site.express import Express
from study.site.forgetting import forget_regularly
from study.site.headers import SecureHeaders
from study.site.language import RememberLanguage
from study.site.media import ClipShelf
from study.site.place import Place

# Threads that answer requests. More of them only take the interpreter from each other, above all
# from the one that writes: with 40 a crowd was answered half as fast (docs/load.md).
THREADS: Final = 16
# In the order in which they are asked for a path: what comes most stands first.
ROOMS = (
    news,
    trial,
    way,
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
        forgetting = asyncio.create_task(forget_regularly(place.db))
        yield
        forgetting.cancel()
        await asyncio.wait([forgetting])
        place.writer.close()
        place.db.close()

    app = Express(title="Ocularist", openapi_url=None, lifespan=lifespan)
    app.state.place = place
    app.add_middleware(RememberLanguage)
    app.add_middleware(SecureHeaders)
    for room in ROOMS:
        app.include_router(room.router)
    handle_errors(app)
    return app
