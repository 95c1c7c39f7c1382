"""The page that checks screen, browser and connection: what it shows, for whom."""

from __future__ import annotations

import secrets
from collections.abc import Mapping, Sequence
from itertools import islice
from typing import Any, Final

from fastapi.responses import Response

from study.data import before
from study.data.before import DEVICE_FAILED
from study.design import patches
from study.design.definition import StudyDefinition
from study.design.device_check import DeviceCheck, DeviceReport
from study.site.access import Visitor
from study.site.frame import words_of
from study.site.media import clip_url
from study.site.place import Place
from study.site.way import on_the_way

STEP: Final = "device_check"
STRIPS: Final = ("dark", "light")
MOST_CLIPS: Final = 3  # of the study's own, to measure the connection


def check_of(definition: StudyDefinition) -> DeviceCheck:
    """Return what a study wants to be checked, or what is usual."""
    return definition.device_check or DeviceCheck()


def content_of(
    here: Place,
    definition: StudyDefinition,
    frame: Mapping[str, Any],
    *,
    strips: Mapping[str, Sequence[object]],
    clips: Sequence[str],
    may_leave: bool,
    given: DeviceReport | None = None,
    stopping: tuple[str, ...] = (),
    fault: str = "",
) -> dict[str, Any]:
    """Return what the page shows; ``strips`` hold grey levels, or places for them."""

    def named(item: str, part: str, **values: object) -> object:
        return frame["text"](f"device_check.{item}.{part}", **values)

    return {
        "named": named,
        "check": check_of(definition),
        "sizes": sorted(definition.sizes, key=lambda size: size.width * size.height),
        "squares": [len(strips[strip]) for strip in STRIPS],
        "strips": strips,
        "self_test": self_test_url(here),
        "patches": [list(patch) for patch in patches.PATCHES],
        "patch_px": patches.PATCH_PX,
        "columns": patches.COLUMNS,
        "clips": clips,
        "given": given,
        "stopping": stopping,
        "fault": fault,
        "may_leave": may_leave,
    }


def page_with_faults(
    report: DeviceReport | None, stopping: tuple[str, ...], here: Place, visitor: Visitor
) -> Response:
    """Show the page with what stops somebody, or that nothing could be read."""
    definition, seed = visitor.study.definition, visitor.participant.seed
    frame = on_the_way(here, visitor, STEP)
    tried = before.times(here.db, visitor.participant, DEVICE_FAILED)
    content = content_of(
        here,
        definition,
        frame,
        strips={strip: patches.strip_levels(seed, strip) for strip in STRIPS},
        clips=clip_urls_of(here, visitor),
        may_leave=tried >= check_of(definition).tries,
        given=report,
        stopping=stopping,
        fault="" if stopping else "device_check.unreadable",
    )
    page = "participant/device_check.html"
    return here.page(page, status=422, **frame, **content, key=secrets.token_hex(16))


def self_test_url(here: Place) -> str:
    """Return the address of the clip of known colours; "" where it was not made."""
    return f"/self-test/{patches.self_test_name()}" if has_self_test(here) else ""


def has_self_test(here: Place) -> bool:
    """Say whether the clip of known colours was made."""
    return (here.settings.media_folder / patches.self_test_name()).is_file()


def clip_urls_of(here: Place, visitor: Visitor) -> list[str]:
    """Return some of the study's clips that are rendered: the connection is measured by them."""
    words = words_of(visitor.study, visitor)
    ids = here.parts.of(visitor.study.definition, words.markup).clip_ids
    urls = (clip_url(record) for one in ids if (record := here.clips.record(one)) is not None)
    return list(islice(urls, MOST_CLIPS))
