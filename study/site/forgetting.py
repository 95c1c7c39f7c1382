"""What limits counted is forgotten when its time is over, even where nobody comes any more.

A keyed hash of an address, and when somebody joined from it, is not to outlive a withdrawal.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Final

from fastapi.concurrency import run_in_threadpool

from study.data import limits
from study.data.database import Database

EVERY_S: Final = limits.JOINING.per.total_seconds()


async def forget_regularly(
    db: Database, *, pause: Callable[[float], Awaitable[object]] = asyncio.sleep
) -> None:
    """Forget what is over every ten minutes, until cancelled."""
    while True:
        await pause(EVERY_S)
        await run_in_threadpool(limits.forget, db)
