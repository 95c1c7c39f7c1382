"""A small study file to break in one place at a time."""

from __future__ import annotations

from typing import Any

import pytest

TEXT_PAGE = {"title": "Title", "button": "Go on", "paragraphs": [{"text": "Words."}]}
LEVELS = ("texture", "refraction", "reflection", "subsurface", "caustics", "tessellation", "sclera")


@pytest.fixture
def raw() -> dict[str, Any]:
    """Return the contents of a sound study file with two LoDs and two clips."""
    return {
        "key": "small",
        "version": "1",
        "title": "A small study",
        "contact": {"name": "Nobody", "email": "nobody@example.org"},
        "sizes": ["320x180", "640x360"],
        "distances": ["near", "far"],
        "orbit": {"duration_s": 1.0, "fps": 10},
        "lods": {
            "low": dict.fromkeys(LEVELS, "low"),
            "ultra": dict.fromkeys(LEVELS, "ultra"),
            "no-caustics": {"base": "ultra", "caustics": "off"},
        },
        "practice": [{"id": "p", "distance": "near", "left": "low", "right": "no-caustics"}],
        "clips": [
            {"id": "a", "distance": "near", "left": "low", "right": "ultra"},
            {"id": "b", "distance": "far", "left": "ultra", "right": "low"},
        ],
        "consent": {**TEXT_PAGE, "version": "1"},
        "about": [{"id": "age", "kind": "number", "text": "Age?", "minimum": 18, "maximum": 99}],
        "about_page": TEXT_PAGE,
        "instructions": TEXT_PAGE,
        "questions": [
            {
                "id": "noticed",
                "kind": "choice",
                "text": "Different?",
                "options": [{"value": v, "label": v} for v in ("yes", "no", "unsure")],
            },
            {
                "id": "what_differed",
                "kind": "text",
                "text": "What?",
                "max_chars": 20,
                "shown_if": {"question": "noticed", "values": ["yes"]},
            },
            {
                "id": "rating_left",
                "kind": "scale",
                "text": "How real?",
                "lowest_label": "not",
                "highest_label": "very",
            },
        ],
        "thanks": {"title": "Thanks", "paragraphs": [{"text": "Bye."}]},
    }
