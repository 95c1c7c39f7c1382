"""How long one visit takes, part by part: an estimate from the study file alone.

Reading goes by Brysbaert 2019 (238 words a minute, silently, non-fiction in English); the other
numbers are what our own trials took, rounded up. Pure.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from study.design.definition import StudyDefinition
from study.design.questions import Asked, NumberQuestion, Question, TextQuestion, each_asked
from study.design.texts import Paragraph

WORDS_PER_S: Final = 238 / 60
VIEWS: Final = 1.4  # some watch a clip again
BETWEEN_CLIPS_S: Final = 2.0  # press play, let the next page appear
CHOICE_S, NUMBER_S, TEXT_S = 3.0, 5.0, 10.0  # a scale is a choice; a text is a few words
TEXT_SHARE: Final = 1 / 3  # so many write something where they need not
SHOWN_SHARE: Final = 1 / 2  # so often a question with a rule is shown
STEPS_S: Final = {"device_check": 40.0, "calibration": 75.0, "eyesight": 90.0}
OWN_WORDS: Final = 205  # of every consent: the motion warning, and what withdrawing means
PREPARING_S: Final = 15.0
BREAK_S: Final = 20.0


def visit_parts(definition: StudyDefinition) -> dict[str, float]:
    """Return what one visit consists of and how long each part takes, in seconds."""
    clips = len(definition.practice) + definition.trial_count
    views = max(VIEWS, definition.order.min_views)
    steps = [name for name in STEPS_S if getattr(definition, name, None) is not None]
    consent, about = definition.consent, definition.about_page
    parts = {
        "consent": _reading_s(consent.paragraphs, consent.statements) + OWN_WORDS / WORDS_PER_S,
        "questions about you": _reading_s(about.paragraphs) + _answering_s(definition.about)
        if definition.about
        else 0.0,
        **{name.replace("_", " "): STEPS_S[name] for name in steps},
        "instructions": _reading_s(definition.instructions.paragraphs) + PREPARING_S,
        "watching": clips * (views * _clip_s(definition) + BETWEEN_CLIPS_S),
        "answering": clips * _answering_s(definition.questions),
        "breaks and questions between": sum(
            BREAK_S if pause.attention is None else _answering_s([pause.attention.question]) + 5.0
            for pause in definition.pauses
        )
        + _answering_s(each.question for each in definition.attention_within),
        "end": _reading_s(definition.thanks.paragraphs),
    }
    return {name: seconds for name, seconds in parts.items() if seconds}


def minutes(definition: StudyDefinition) -> float:
    """Estimate how long one visit takes, in minutes."""
    return sum(visit_parts(definition).values()) / 60


def _clip_s(definition: StudyDefinition) -> float:
    """Return the mean length of a clip: approaches have one of their own."""
    clips = (*definition.practice, *definition.blocks[0], *definition.gold)
    lengths = [
        definition.approach.duration_s if clip.motion == "approach" else definition.orbit.duration_s
        for clip in clips
    ]
    return sum(lengths) / len(lengths)


def _reading_s(paragraphs: Iterable[Paragraph], more: Iterable[str] = ()) -> float:
    texts = [f"{paragraph.heading} {paragraph.text}" for paragraph in paragraphs]
    return sum(len(text.split()) for text in (*texts, *more)) / WORDS_PER_S


def _answering_s(questions: Iterable[Question]) -> float:
    return sum(_question_s(question) for question in each_asked(questions))


def _question_s(question: Asked) -> float:
    seconds = CHOICE_S
    if isinstance(question, TextQuestion):
        seconds = TEXT_S if question.is_required else TEXT_S * TEXT_SHARE
    elif isinstance(question, NumberQuestion):
        seconds = NUMBER_S
    return seconds if question.shown_if is None else seconds * SHOWN_SHARE
