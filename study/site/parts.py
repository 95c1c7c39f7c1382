"""Parts of pages that are the same for everybody in a study: made once, not with every page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import jinja2
from markupsafe import Markup

from study.design.definition import StudyDefinition
from study.design.questions import Question
from study.site.forms import question_rows
from study.site.mould import Moulds
from study.site.time_left import trial_s

MOST: Final = 200
"""Studies, times languages, that are kept; then it begins anew."""


@dataclass(frozen=True)
class Parts:
    """What every trial's page of a study has: its questions, how long a trial takes, its moulds."""

    definition: StudyDefinition
    rows: list[list[Question]]
    blank: Markup
    estimate_s: float
    moulds: Moulds = field(default_factory=Moulds)

    @cached_property
    def clip_ids(self) -> tuple[str, ...]:
        """The ids of every clip in any size and direction; each is a hash, which takes its time."""
        return tuple(one.spec.clip_id for one in self.definition.wanted_specs())

    def rows_of(self, questions: Sequence[Question]) -> list[list[Question]]:
        """Return a trial's questions in rows: those of every trial, unless it asks others."""
        return self.rows if questions is self.definition.questions else question_rows(questions)


@dataclass
class PartsShelf:
    """Parts by the definition that they were made from; another version is another object."""

    pages: jinja2.Environment
    _kept: dict[int, Parts] = field(default_factory=dict)

    def of(self, definition: StudyDefinition, text: Callable[..., Any]) -> Parts:
        """Return the parts of a study in one language, whose catalogue is ``text``."""
        kept = self._kept.get(id(definition))
        if kept is None:
            if len(self._kept) >= MOST:
                self._kept.clear()
            kept = self._kept[id(definition)] = self._made(definition, text)
        return kept

    def _made(self, definition: StudyDefinition, text: Callable[..., Any]) -> Parts:
        """Make them; they hold on to the definition, so that no other gets its identity."""
        rows = question_rows(definition.questions)
        questions: Any = self.pages.get_template("participant/questions.html").make_module(
            {"text": text}
        )
        blank = Markup(questions.questionnaire(rows, {}, {}))
        return Parts(definition, rows, blank, trial_s(definition))
