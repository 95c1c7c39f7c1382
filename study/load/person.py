"""A simulated person of a crowd: walks the pages as fast as they come and answers at random.

They note what was acknowledged, so that it can be compared with what is stored.
"""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from study.bots import complete_play
from study.checking import calibration_report, device_report, eyesight_report
from study.design.definition import StudyDefinition, read_definition
from study.design.questions import (
    ChoiceQuestion,
    NumberQuestion,
    Question,
    ScaleQuestion,
    each_asked,
)
from study.load.visit import Acknowledged, StuckError, Visit

LARGE_SCREEN: Final = {"screen_width_px": 3840, "screen_height_px": 2160}


@dataclass
class Person(Visit):
    """One simulated person; ``walk`` takes them from the consent to the completion code.

    ``uses_outbox`` False leaves out the answers that a browser reports one by one.
    """

    definition: StudyDefinition = field(default_factory=lambda: read_definition("thesis"))
    uses_outbox: bool = True

    async def walk(self) -> Acknowledged:
        """Take part; returns what was acknowledged. Raises StuckError."""
        await self.open("/consent")
        steps = {
            "/consent": self._agree,
            "/about-you": self._tell,
            "/device-check": self._show_screen,
            "/calibration": self._measure,
            "/eyesight": self._see,
            "/preparing": self._prepare,
        }
        while self.path != "/thanks":
            before = self.path
            if before.startswith("/trial/"):
                await self._rate()
            else:
                await steps.get(before, self._read)()
        self.stored.code = self.found(r'id="completion-code"[^>]*>\s*([^<\s]+)')
        self.wire.close()
        return self.stored

    async def _agree(self) -> None:
        count = len(re.findall(r'name="agree"', self.page))
        version = html.unescape(self.found(r'name="version" value="([^"]*)"'))
        ticket = html.unescape(self.found(r'name="ticket" value="([^"]*)"'))
        agreed = [str(n + 1) for n in range(count)]
        fields = {"version": version, "ticket": ticket, "agree": agreed}
        await self.post("/consent", fields, kind="consent")

    async def _tell(self) -> None:
        fields = {"key": self.key(), **_answers(self.definition.about, self.rng)}
        await self.post("/about-you", fields)

    async def _show_screen(self) -> None:
        dark, light = map(int, self.data("squares").split())
        await self._report(device_report(self.definition, (dark, light)))

    async def _measure(self) -> None:
        await self._report(calibration_report(self.definition, self.rng))

    async def _see(self) -> None:
        if 'action="/eyesight/consent"' in self.page:
            await self.post("/eyesight/consent", {"agree": "yes"})
        await self._report(eyesight_report(self.definition, None))

    async def _report(self, report: Mapping[str, Any]) -> None:
        await self.post(self.path, {"key": self.key(), "report": json.dumps(report)})

    async def _read(self) -> None:
        await self.post(self.path, {"key": self.key()})

    async def _prepare(self) -> None:
        query = "&".join(f"{name}={value}" for name, value in LARGE_SCREEN.items())
        answered = await self.sent("page", lambda: self.wire.get(f"/preparing/state?{query}"))
        if answered.status != 200 or not json.loads(answered.body)["is_ready"]:
            raise StuckError(f"the clips are not ready: {answered.text[:200]}")
        await self.post("/preparing", {**LARGE_SCREEN, "pixel_ratio": 1})

    async def _rate(self) -> None:
        position = int(self.data("position"))
        frames = int(self.data("frames"))
        for _ in range(int(self.data("views_left"))):
            play = {"kind": "play", "position": position, "play": complete_play(frames)}
            await self.report(play, "play")
        number = position - len(self.definition.practice)
        asked = self.definition.questions_at(number, is_practice=number < 1)
        given = _answers(asked, self.rng)
        if self.uses_outbox:
            for question, value in given.items():
                entry = {"kind": "answer", "position": position}
                await self.report({**entry, "question": question, "value": value}, "answer")
        path = self.path
        fields = {"key": self.key(), "response_ms": 1500, **given}
        await self.post(path, fields, kind="questionnaire")
        if self.path != path:
            self.stored.forms[position] = given


def _answers(questions: tuple[Question, ...], rng: np.random.Generator) -> dict[str, str]:
    return {question.id: _answer(question, rng) for question in each_asked(questions)}


def _answer(question: Question, rng: np.random.Generator) -> str:
    if isinstance(question, ScaleQuestion):
        return str(int(rng.integers(question.lowest, question.highest + 1)))
    if isinstance(question, ChoiceQuestion):
        return str(question.options[int(rng.integers(len(question.options)))].value)
    if isinstance(question, NumberQuestion):
        return str(int(rng.integers(int(question.minimum), int(question.maximum) + 1)))
    return f"Words of no meaning, number {int(rng.integers(10_000))}."
