"""Forms: how questions stand on a page, and how a posted form is read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final
from urllib.parse import parse_qsl

from fastapi import HTTPException, Request

from study.design.questions import MultipleQuestion, Question, each_asked

# A whole questionnaire of the longest texts stays far below; more is no form of ours.
MAX_FORM_BYTES: Final = 256 * 1024
MAX_FIELDS: Final = 200
PLAIN: Final = "application/x-www-form-urlencoded"
Fields = Mapping[str, Sequence[str]]


def question_rows(questions: Sequence[Question]) -> list[list[Question]]:
    """Put a question about the left eye and its twin about the right eye into one row."""
    rows: list[list[Question]] = []
    for question in questions:
        last = rows[-1] if rows else []
        if len(last) == 1 and _is_pair(last[0].id, question.id):
            last.append(question)
        else:
            rows.append([question])
    return rows


def _is_pair(first: str, second: str) -> bool:
    return first.endswith("_left") and second == first.removesuffix("left") + "right"


async def read_form(request: Request) -> dict[str, list[str]]:
    """Read a posted form into field -> values; files are no answer and are left out."""
    if request.headers.get("content-type", "").startswith(PLAIN):
        return _plain_form(await request.body())
    form = await request.form(max_files=0, max_fields=MAX_FIELDS, max_part_size=MAX_FORM_BYTES)
    fields: dict[str, list[str]] = {}
    for name, value in form.multi_items():
        if isinstance(value, str):
            fields.setdefault(name, []).append(value)
    return fields


def _plain_form(body: bytes) -> dict[str, list[str]]:
    """Read what a browser sends of a form without files."""
    fields: dict[str, list[str]] = {}
    try:
        pairs = parse_qsl(
            body.decode("latin-1"),
            keep_blank_values=True,
            errors="replace",
            max_num_fields=MAX_FIELDS,
        )
    except ValueError:
        raise HTTPException(400) from None
    for name, value in pairs:
        if len(value) > MAX_FORM_BYTES:
            raise HTTPException(400)
        fields.setdefault(name, []).append(value)
    return fields


def first(fields: Mapping[str, Sequence[str]], name: str) -> str:
    """Return a field's first value, or nothing."""
    values = fields.get(name, ())
    return values[0] if values else ""


def answers_in(
    fields: Mapping[str, Sequence[str]], questions: Sequence[Question]
) -> dict[str, object]:
    """Return question id -> what was posted for each; one left out was skipped."""
    return {
        question.id: list(fields.get(question.id, ()))
        if isinstance(question, MultipleQuestion)
        else first(fields, question.id)
        for question in each_asked(questions)
    }
