"""What the checks before the clips have in common: a report that came, kept or asked for again.

Pages of somebody who has just come are cast and reports are errands among those of everybody else;
a page that says what was wrong is rendered whole, in a thread.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from fastapi import Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import Response

from study.data import before, progress
from study.data.checks import CheckName
from study.data.errands import Errand
from study.design.definition import StudyDefinition
from study.site.access import Visitor, redirect, step_url, visitor_or_none
from study.site.asker import nobody
from study.site.forms import first
from study.site.place import Place
from study.site.way import Sent

Facts = Mapping[str, Any]


def is_at(who: Any, definition: StudyDefinition, check: CheckName) -> Errand[bool]:
    """Say whether somebody is at a check; ``who`` is their row."""
    return (yield from progress.stepping(who, definition)).name == check


def keeping(
    sent: Sent,
    who: Any,
    definition: StudyDefinition,
    check: CheckName,
    *,
    report: Mapping[str, Any],
    facts: Facts,
) -> Errand[None]:
    """Store what came of a check with which its sender is done then."""
    key = first(sent.fields, "key") or check
    yield from before.recording(
        sent.here.db, who, definition, check, key=key, report=report, facts=facts
    )


async def once_more(
    request: Request, sent: Sent, check: CheckName, page: Callable[[Place, Visitor], Response]
) -> Response:
    """Show a check's page again, with what was wrong; whoever is elsewhere by now is led there."""
    return await run_in_threadpool(_again, request, sent, check, page)


def _again(
    request: Request, sent: Sent, check: CheckName, page: Callable[[Place, Visitor], Response]
) -> Response:
    visitor = visitor_or_none(request, sent.here)
    if visitor is None:
        raise nobody(request)
    step = progress.current_step(sent.here.db, visitor.participant)
    return page(sent.here, visitor) if step.name == check else redirect(step_url(step))
