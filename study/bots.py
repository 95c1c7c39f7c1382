"""Simulated participants that walk the real pages, from consent to completion code.

They send what a browser sends to the same addresses, answer with ``analysis``'s observers, and are
labelled as simulated: the site believes that only with a token signed by its own data folder. What
a page does not tell (it never tells the condition) they look up in the clips' manifest.
"""

from __future__ import annotations

import json
import urllib.request
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import urlencode, urljoin

import numpy as np

from analysis import Answer, Observer, Stimulus, draw_observer
from renderer.manifest import read_manifest
from study.answering import about_answers, attention_answer, stimulus, trial_answers
from study.browser import BotError, Browser
from study.checking import calibration_report, device_report, eyesight_report
from study.design.definition import StudyDefinition
from study.design.questions import Value
from study.site.media import clip_url


def stimuli(definition: StudyDefinition, media_folder: Path) -> dict[str, Stimulus]:
    """Return clip address -> what an observer sees there, from the manifest beside the clips."""
    manifest = read_manifest(media_folder)
    return {
        clip_url(manifest.clips[wanted.spec.clip_id]): stimulus(
            definition, wanted.clip.id, size=str(wanted.size), orbit=wanted.orbit_direction
        )
        for wanted in definition.wanted_specs()
        if wanted.spec.clip_id in manifest.clips
    }


def walk(
    url: str,
    definition: StudyDefinition,
    *,
    media_folder: Path,
    simulation_token: str,
    participants: int,
    seed: int,
    report: Callable[[int], None] = lambda _done: None,
) -> list[str]:
    """Let simulated people take part one after the other; returns their completion codes.

    ``simulation_token`` is ``study.site.signatures.simulation_token`` of the site's secret key.
    ``report`` hears how many are done. Raises BotError saying where someone could not go on.
    """
    seen = stimuli(definition, media_folder)
    codes = []
    for number in range(participants):
        rng = np.random.default_rng([seed, number])
        codes.append(take_part(Browser(url, simulation_token), definition, seen=seen, rng=rng))
        report(number + 1)
    return codes


def take_part(
    browser: Browser,
    definition: StudyDefinition,
    *,
    seen: Mapping[str, Stimulus],
    rng: np.random.Generator,
) -> str:
    """Walk one simulated person through the pages; returns the completion code."""
    observer = draw_observer(rng)
    ticks = [str(number + 1) for number in range(definition.consent.tick_count)]
    browser.get("/consent")
    browser.post("/consent", {"agree": ticks, "health": "yes"})
    if browser.page.path == "/about-you":
        browser.post("/about-you", _filled(about_answers(definition, observer, rng)))
    _check(browser, definition, rng)
    browser.post("/instructions", {})
    _prepare(browser, definition)
    while browser.page.path.startswith(("/trial/", "/pause")):
        if browser.page.path == "/pause":
            _pause(browser, definition, observer, rng)
        else:
            _rate(browser, definition, observer=observer, seen=seen, rng=rng)
    if not browser.page.completion_code:
        raise BotError(f"{browser.page.path}: a simulated participant got no completion code")
    return browser.page.completion_code


def _check(browser: Browser, definition: StudyDefinition, rng: np.random.Generator) -> None:
    """Pass the checks before the clips; the plates are left out, for no bot sees them."""
    reports: dict[str, Callable[[], dict[str, Any]]] = {
        "/device-check": lambda: device_report(definition, _squares(browser)),
        "/calibration": lambda: calibration_report(definition, rng),
        "/eyesight": lambda: eyesight_report(definition, None),
    }
    while (path := browser.page.path) in reports:
        if path == "/eyesight" and "rings" not in browser.page.data:
            browser.post("/eyesight/consent", {"agree": "yes"})
        browser.post(path, {"report": json.dumps(reports[path]())})
        if browser.page.path == path:
            raise BotError(f"{path}: the site did not take what a simulated participant reported")


def _squares(browser: Browser) -> tuple[int, int]:
    """Count the squares of the page's two strips."""
    dark, light = browser.page.data["squares"].split()
    return int(dark), int(light)


def _prepare(browser: Browser, definition: StudyDefinition) -> None:
    """Wait for nothing: the clips have to be there, and every one has to be served."""
    largest = max(definition.sizes, key=lambda size: size.width)
    screen = {"screen_width_px": largest.width, "screen_height_px": largest.height}
    address = urljoin(browser.url, f"/preparing/state?{urlencode(screen)}")
    state = json.loads(browser.read(urllib.request.Request(address)))
    if not state["is_ready"]:
        raise BotError(
            f"the clips are not rendered yet ({state['progress']:.0%}); wait until those of one "
            "size are there, or simulate without --through-site"
        )
    for clip in state["clips"]:
        headers = {"Range": "bytes=0-1"}
        request = urllib.request.Request(urljoin(browser.url, clip["url"]), headers=headers)
        if len(browser.read(request)) != 2:
            raise BotError(f"{clip['url']}: the site does not serve byte ranges")
    browser.post("/preparing", {**screen, "pixel_ratio": 1})


def _pause(
    browser: Browser, definition: StudyDefinition, observer: Observer, rng: np.random.Generator
) -> None:
    """Rest for no time at all, or answer the question that stands between trials."""
    name = browser.page.hidden["pause"]
    pause = next(one for one in definition.pauses if one.key == name)
    browser.post("/pause", _filled(attention_answer(pause.attention, observer, rng)))
    if browser.page.hidden.get("pause") == name:
        raise BotError(
            f"/pause: the site did not take what a simulated participant answered: {name}"
        )


def _rate(
    browser: Browser,
    definition: StudyDefinition,
    *,
    observer: Observer,
    seen: Mapping[str, Stimulus],
    rng: np.random.Generator,
) -> None:
    """Watch one clip, answer question by question, then finish the questionnaire."""
    page = browser.page
    position, clip = int(page.data["position"]), page.data["clip"]
    if clip not in seen:
        raise BotError(f"{page.path}: {clip} is in no manifest here; give the site's clips' folder")
    answer = observer.answer(seen[clip], rng, position=position)
    for view in range(max(answer.views, definition.order.min_views)):
        play = complete_play(int(page.data["frames"]))
        key = f"play-{position}-{view}"
        browser.report({"kind": "play", "key": key, "position": position, "play": play})
    number = position - len(definition.practice)
    answers = trial_answers(definition, answer, number=number, observer=observer, rng=rng)
    given = _filled(answers)
    for question, value in given.items():
        entry = {"kind": "answer", "key": f"answer-{position}-{question}", "position": position}
        browser.report({**entry, "question": question, "value": value})
    browser.post(page.path, {**given, "response_ms": _response_ms(answer)})
    if browser.page.path == page.path:
        raise BotError(f"{page.path}: the site did not accept a simulated questionnaire")


def complete_play(frames: int) -> dict[str, Any]:
    """Return the record of a play in which every frame was presented."""
    return {
        "is_complete": True,
        "was_hidden": False,
        "expected_frames": frames,
        "presented_frames": frames,
        "dropped_frames": 0,
        "shown_scale": 1.0,
    }


def _response_ms(answer: Answer) -> int:
    return max(1, answer.response_ms)


def _filled(answers: Mapping[str, Value | None]) -> dict[str, str | list[str]]:
    """Return what a form sends: a skipped question is empty, what is ticked is a list."""
    return {
        name: value if isinstance(value, list) else "" if value is None else str(value)
        for name, value in answers.items()
    }
