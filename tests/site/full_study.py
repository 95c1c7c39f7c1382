"""A small study with every page and every kind of question, in English and Arabic."""

from __future__ import annotations

from typing import Any

from small_study import small_definition

from study.design.definition import StudyDefinition, parse_definition, read_definition

PARTS: list[dict[str, Any]] = [
    {"id": "iris", "label": "Iris"},
    {"id": "white", "label": "White of the eye"},
]
MORE: list[dict[str, Any]] = [
    {
        "id": "where",
        "kind": "multiple",
        "text": "Where did you look?",
        "options": [
            {"value": "iris", "label": "At the iris"},
            {"value": "lids", "label": "At the lids"},
            {"value": "nowhere", "label": "Nowhere in particular", "is_exclusive": True},
        ],
    },
    {
        "id": "alive",
        "kind": "analogue",
        "text": "How alive do these eyes look?",
        "lowest_label": "not at all",
        "highest_label": "fully alive",
    },
    {
        "id": "detail",
        "kind": "matrix",
        "text": "How detailed is each part?",
        "labels": ["poor", "fair", "good"],
        "highest": 3,
        "rows": PARTS,
        "per_eye": True,
    },
    {
        "id": "confidence",
        "kind": "number",
        "text": "How sure are you?",
        "minimum": 0,
        "maximum": 1,
        "decimals": 2,
        "unit": "from 0 to 1",
        "shown_if": {"question": "rating_left", "at_least": 4},
    },
    {"id": "word", "kind": "text", "text": "One word for these eyes?", "is_long": False},
]
MORE_IN_ARABIC: dict[str, Any] = {
    "where": {
        "text": "إلى أين نظرت؟",
        "options": {"iris": "إلى القزحية", "lids": "إلى الجفنين", "nowhere": "لا مكان بعينه"},
    },
    "alive": {
        "text": "كم تبدو هاتان العينان حيّتين؟",
        "lowest_label": "إطلاقًا",
        "highest_label": "تمامًا",
    },
    "detail": {
        "text": "ما مقدار التفاصيل في كل جزء؟",
        "labels": ["قليل", "متوسط", "جيد"],
        "rows": {"iris": "القزحية", "white": "بياض العين"},
    },
    "confidence": {"text": "ما مدى تأكدك؟", "unit": "من 0 إلى 1"},
    "word": {"text": "كلمة واحدة لهاتين العينين؟"},
}


def full_definition() -> StudyDefinition:
    """Return the study."""
    lod = read_definition("lod").model_dump(mode="json", exclude_unset=True)
    thesis = read_definition("thesis").model_dump(mode="json", exclude_unset=True)
    small = small_definition().model_dump(mode="json", exclude_unset=True)
    arabic = thesis["translations"]["ar"]
    more = {name: lod["translations"]["ar"][name] for name in ("breaks", "attention")}
    return parse_definition(
        small
        | {
            "breaks": lod["breaks"] | {"after": [1]},
            "attention": [lod["attention"][0] | {"after": 1}],
            "device_check": {},
            "calibration": {},
            "eyesight": {},
            "questions": [*small["questions"], *MORE],
            "translations": {
                "ar": arabic | more | {"questions": arabic["questions"] | MORE_IN_ARABIC}
            },
        }
    )
