"""A study: what its file says, and what follows from it for people, pages and tables.

Pure. ``study.design.contents`` has the file's tables, ``study.design.wanted`` the clips.
"""

from __future__ import annotations

import hashlib
import json
from functools import cached_property

from renderer.clip import PATHS
from study.design.attention import Attention, with_attention
from study.design.completion import Completion
from study.design.files import without_later_keys, without_paths
from study.design.pauses import Pause, all_pauses
from study.design.questions import Question
from study.design.recruiting import Recruiting
from study.design.translations import translated
from study.design.wanted import WithClips


class StudyDefinition(WithClips):
    """Everything that makes one study: what is shown, to whom, in which order, with which words."""

    @property
    def pauses(self) -> tuple[Pause, ...]:
        """What comes between trials, in order."""
        return all_pauses(self.breaks, self.attention)

    @cached_property
    def attention_within(self) -> tuple[Attention, ...]:
        """The attention questions that stand among those of a trial."""
        return tuple(each for each in self.attention if each.within is not None)

    def questions_at(self, number: int, *, is_practice: bool) -> tuple[Question, ...]:
        """Return what is asked in a trial, by its number among those of its kind."""
        here = [each for each in self.attention_within if each.within == number]
        return with_attention(self.questions, here) if here and not is_practice else self.questions

    @property
    def questions_of_all_trials(self) -> tuple[Question, ...]:
        """Everything that some trial asks, each question once."""
        return (*self.questions, *(each.question for each in self.attention_within))

    @property
    def endings(self) -> Completion:
        """What each outcome of a session leads to."""
        return self.completion or Completion()

    @property
    def entrance(self) -> Recruiting:
        """How people are let in."""
        return self.recruiting or Recruiting()

    @property
    def languages(self) -> tuple[str, ...]:
        """The languages that the study's words are written in, its own first."""
        return (self.language, *self.translations)

    def in_language(self, language: str) -> StudyDefinition:
        """Return the study with its words in one of its languages; as it is for any other."""
        return self._translated.get(language, self)

    @cached_property
    def _translated(self) -> dict[str, StudyDefinition]:
        return {
            language: translated(self, words, language)
            for language, words in self.translations.items()
        }

    def to_json(self) -> str:
        """Write the definition as JSON in the file's order; ``parse_definition`` reads it back."""
        return json.dumps(self.model_dump(mode="json"), ensure_ascii=False)

    @property
    def definition_hash(self) -> str:
        """16 hexadecimal digits over the contents.

        Comments, the order of keys and the places of pictures do not matter, nor do keys that came
        later as long as they are left out.
        """
        told = without_later_keys(self.model_dump(mode="json"))
        text = json.dumps(without_paths(told, PATHS), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]
