"""What one answer is worth: from what a form or script gives to the value that is stored.

Pure. A faulty answer is refused with a reason that the catalogue has words for.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from study.design.question_kinds import (
    AnalogueQuestion,
    Asked,
    ChoiceQuestion,
    MultipleQuestion,
    NumberQuestion,
    Question,
    ScaleQuestion,
    TextQuestion,
    Value,
)
from study.design.reasons import Reason, UnfitError


def accepted_values(question: Question) -> tuple[int | str, ...]:
    """Return the values that a choice or scale can take; empty for all else."""
    if isinstance(question, ChoiceQuestion | MultipleQuestion):
        return tuple(option.value for option in question.options)
    if isinstance(question, ScaleQuestion):
        return tuple(range(question.lowest, question.highest + 1))
    return ()


def read_answer(question: Asked, given: object) -> Value | None:
    """Read one answer; None when skipped. Raises UnfitError with the reason."""
    if isinstance(question, MultipleQuestion):
        return _read_ticks(question, given if isinstance(given, list | tuple) else [given])
    if given is None or (isinstance(given, str) and not given.strip()):
        return None
    text = str(given).strip()
    if isinstance(question, TextQuestion):
        return _read_text(question, text)
    if isinstance(question, NumberQuestion):
        return _read_number(question, text)
    if isinstance(question, AnalogueQuestion):
        return _read_place(question, text)
    for value in accepted_values(question):
        if text == str(value):
            return value
    raise UnfitError(Reason("answer.choose"))


def _read_ticks(question: MultipleQuestion, given: Sequence[object]) -> list[str] | None:
    """Return the ticked values in the file's order; nothing ticked is a skipped question."""
    ticked = {str(value).strip() for value in given if value is not None} - {""}
    chosen = [option for option in question.options if option.value in ticked]
    if len(chosen) < len(ticked):
        raise UnfitError(Reason("answer.choose"))
    if not chosen:
        return None
    alone = next((option for option in chosen if option.is_exclusive), None)
    if alone is not None and len(chosen) > 1:
        raise UnfitError(Reason("answer.alone", {"option": alone.label}))
    if question.most is not None and len(chosen) > question.most:
        raise UnfitError(Reason("answer.at_most", {"count": question.most}))
    if len(chosen) < question.fewest and alone is None:
        raise UnfitError(Reason("answer.at_least", {"count": question.fewest}))
    return [option.value for option in chosen]


def _read_text(question: TextQuestion, text: str) -> str | None:
    # U+0000 cannot be stored by PostgreSQL; lone surrogates cannot be encoded at all.
    cleaned = text.replace("\x00", "").replace("\r\n", "\n").strip()
    cleaned = cleaned.encode("utf-8", "replace").decode("utf-8")
    if len(cleaned) > question.max_chars:
        limits = {"most": question.max_chars, "count": len(cleaned)}
        raise UnfitError(Reason("answer.too_long", limits))
    return cleaned or None  # a text of nothing but such characters is a skipped question


# Digits of any script; a point, a comma or the Arabic decimal mark before decimals.
_NUMBER: Final = re.compile(r"([+-]?\d{1,15})(?:[.,٫](\d{1,15}))?")


def _read_number(question: NumberQuestion, text: str) -> int | float:
    limits: dict[str, object] = {"lowest": question.minimum, "highest": question.maximum}
    key = "answer.number" if question.decimals else "answer.whole_number"
    refusal = UnfitError(Reason(key, {**limits, **_places(question)}))
    found = _NUMBER.fullmatch(text.replace("−", "-"))
    if found is None or len(found[2] or "") > question.decimals:
        raise refusal
    value = float(f"{found[1]}.{found[2] or 0}")
    if not question.minimum <= value <= question.maximum:
        raise refusal
    return value if question.decimals else int(value)


def _places(question: NumberQuestion) -> dict[str, object]:
    return {"count": question.decimals} if question.decimals else {}


def _read_place(question: AnalogueQuestion, text: str) -> int:
    found = _NUMBER.fullmatch(text)
    value = None if found is None or found[2] else int(found[1])
    if value is None or not question.minimum <= value <= question.maximum:
        raise UnfitError(Reason("answer.choose"))
    return value
